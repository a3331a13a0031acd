// SPDX-License-Identifier: MIT
#include "outputs/film.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

#include "outputs/output_file.h"
#include "posix/descriptor.h"

namespace ziggurat::outputs {

const char* const film_endings = ".mp4, .webm, .webp or .gif";

namespace {

using Arguments = std::vector<std::string>;

constexpr int film_of_child = 3;  // its descriptor
constexpr const char* even_sides = "pad=ceil(iw/2)*2:ceil(ih/2)*2";

/// Arguments with which ffmpeg makes the format of an ending; empty: it is not supported.
Arguments encoder_of(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending == ".mp4") {
    return {"-vf",  even_sides, "-c:v",     "libx264", "-preset",   "veryfast",
            "-crf", "20",       "-pix_fmt", "yuv420p", "-movflags", "+faststart"};
  }
  if (ending == ".webm") {
    return {"-vf",     even_sides, "-c:v",      "libvpx-vp9", "-crf",      "32",
            "-b:v",    "0",        "-deadline", "realtime",   "-cpu-used", "6",
            "-row-mt", "1",        "-pix_fmt",  "yuv420p"};
  }
  if (ending == ".webp") {
    return {"-c:v", "libwebp_anim", "-quality", "70", "-compression_level", "4", "-loop", "0"};
  }
  if (ending == ".gif") {  // a palette for each frame: nothing but one frame is kept in memory
    return {"-filter_complex",
            "split[a][b];[a]palettegen=stats_mode=single[p];[b][p]paletteuse=new=1:dither=none",
            "-loop", "0"};
  }
  return {};
}

/// The program's path; empty: it is not there.
std::string find_in_path(const char* name) {
  const char* variable = std::getenv("PATH");
  std::string_view rest = variable ? variable : "/usr/bin:/bin";
  while (!rest.empty()) {
    const std::string_view folder = rest.substr(0, rest.find(':'));
    const std::string path = fmt::format("{}/{}", folder, name);
    if (!folder.empty() && ::access(path.c_str(), X_OK) == 0) return path;
    rest.remove_prefix(std::min(rest.size(), folder.size() + 1));
  }
  return {};
}

/// The streams of a child, and signals as for any program.
class Start {
 public:
  Start(int input, int film, int messages) {
    ::posix_spawn_file_actions_init(&streams_);
    ::posix_spawn_file_actions_adddup2(&streams_, input, STDIN_FILENO);
    ::posix_spawn_file_actions_addopen(&streams_, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_adddup2(&streams_, messages, STDERR_FILENO);
    ::posix_spawn_file_actions_adddup2(&streams_, film, film_of_child);
    ::posix_spawnattr_init(&attributes_);
    sigset_t none, usual;
    ::sigemptyset(&none);
    ::sigemptyset(&usual);
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) ::sigaddset(&usual, number);
    ::posix_spawnattr_setsigmask(&attributes_, &none);
    ::posix_spawnattr_setsigdefault(&attributes_, &usual);
    ::posix_spawnattr_setpgroup(&attributes_, 0);  // Ctrl-C is for this program only
    ::posix_spawnattr_setflags(
        &attributes_, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~Start() {
    ::posix_spawn_file_actions_destroy(&streams_);
    ::posix_spawnattr_destroy(&attributes_);
  }
  Start(const Start&) = delete;
  Start& operator=(const Start&) = delete;

  /// @return errno, or 0
  int operator()(const std::string& program, Arguments& arguments, pid_t& id) const {
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    return ::posix_spawn(&id, program.c_str(), &streams_, &attributes_, pointers.data(), environ);
  }

 private:
  posix_spawn_file_actions_t streams_;
  posix_spawnattr_t attributes_;
};

}  // namespace

bool is_film(const std::string& path) { return !encoder_of(path).empty(); }

Film::Film(std::string path, const FilmFormat& format)
    : path_(std::move(path)), format_(format), program_(find_in_path("ffmpeg")) {
  if (program_.empty()) {
    throw WriteError(fmt::format(
        "{}: films are made by ffmpeg, which is not there; install ffmpeg: sudo apt install ffmpeg",
        path_));
  }
  check_can_be_written(path_);
}

Film::~Film() { end(); }

void Film::start() {
  const posix::Descriptor film(open_alone(path_));  // by which ffmpeg opens it, and keeps it locked
  Arguments arguments{"ffmpeg",
                      "-hide_banner",
                      "-loglevel",
                      "error",
                      "-nostdin",
                      "-y",
                      "-f",
                      "rawvideo",
                      "-pixel_format",
                      "rgb24",
                      "-video_size",
                      fmt::format("{}x{}", format_.width, format_.height),
                      "-framerate",
                      fmt::format("{}", format_.frames_per_second),
                      "-i",
                      "pipe:0",
                      "-an"};
  const Arguments encoder = encoder_of(path_);
  arguments.insert(arguments.end(), encoder.begin(), encoder.end());
  const std::string ending = std::filesystem::path(path_).extension().string();
  arguments.insert(arguments.end(),
                   {"-f", ending.substr(1), fmt::format("file:/dev/fd/{}", film_of_child)});
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) fail(std::strerror(errno));
  input_ = pipe[1];
  messages_ = ::memfd_create("ffmpeg", MFD_CLOEXEC);
  const int error = Start(pipe[0], film.number(), messages_)(program_, arguments, id_);
  ::close(pipe[0]);
  if (error != 0) {
    id_ = -1;
    fail(fmt::format("{} can't be started: {}", program_, std::strerror(error)));
  }
}

void Film::write(std::span<const std::uint8_t> rgb) {
  if (id_ < 0) start();
  while (!rgb.empty()) {
    const ssize_t count = ::write(input_, rgb.data(), rgb.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      end();
      fail("ffmpeg has ended" + complaint());
    }
    rgb = rgb.subspan(static_cast<std::size_t>(count));
  }
  ++frames_;
}

void Film::close() {
  if (id_ < 0) return;
  const int status = end();
  if (status != 0) fail("ffmpeg failed" + complaint());
}

/// The end of the input is the end of the film. Returns the status of waitpid().
int Film::end() {
  if (input_ >= 0) ::close(std::exchange(input_, -1));
  int status = 0;
  if (id_ >= 0) {
    while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    id_ = -1;
  }
  return status;
}

/// The last line that ffmpeg wrote: ": what is wrong".
std::string Film::complaint() const {
  std::array<char, 2048> text{};
  const off_t size = ::lseek(messages_, 0, SEEK_END);
  const off_t from = std::max<off_t>(0, size - static_cast<off_t>(text.size()));
  const ssize_t count = ::pread(messages_, text.data(), text.size(), from);
  std::string_view words(text.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  while (words.ends_with('\n')) words.remove_suffix(1);
  const std::size_t line = words.rfind('\n');
  if (line != std::string_view::npos) words.remove_prefix(line + 1);
  return words.empty() ? std::string() : fmt::format(": {}", words);
}

void Film::fail(const std::string& how) { throw WriteError(fmt::format("{}: {}", path_, how)); }

}  // namespace ziggurat::outputs
