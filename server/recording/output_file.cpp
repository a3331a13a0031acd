#include "recording/output_file.h"

#include <fcntl.h>
#include <linux/magic.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace ziggurat::recording {
namespace {

constexpr std::size_t full_buffer = std::size_t{256} << 10;  // [bytes]

[[noreturn]] void fail(const std::string& path, int error) {
  throw WriteError(fmt::format("{}: cannot be written: {}", path == "-" ? "stdout" : path, std::strerror(error)));
}

using Status = struct stat;

/// A descriptor that is closed with its owner.
class Opened {
 public:
  explicit Opened(int number) : number_(number) {}
  Opened(Opened&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Opened& operator=(Opened&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Opened() {
    if (number_ >= 0) ::close(number_);
  }
  int number() const { return number_; }

 private:
  int number_;
};

/// Walks to where a path leads, from folder to folder and along links, and looks at who has put each of them there. What was
/// looked at stays open, so that it is not exchanged before the file is opened.
class Place {
 public:
  /// See error() and planted() before the rest is used.
  explicit Place(const std::string& path) {
    const std::string begin = path.starts_with('/') ? "/" : working_folder();
    push(path);
    if (begin != ".") push(begin);
    begin_at(begin == "." ? "." : "/");
    while (error_ == 0 && !planted_ && !rest_.empty()) step();
  }

  int error() const { return error_; }  ///< of the system: a folder is not there, or can't be entered
  const std::optional<std::string>& planted() const { return planted_; }

  int open(int flags) const {
    return ::openat(folders_.back().opened.number(), name_.c_str(), flags | (is_of_proc_ ? 0 : O_NOFOLLOW), 0666);
  }

 private:
  struct Folder {
    Opened opened;
    uid_t owner;
    bool all_can_write;
    bool is_planted;  // by another user, in a folder that all can write, or below one that is planted
  };

  static std::vector<std::string> names_of(const std::string& path) {
    std::vector<std::string> names;
    for (std::size_t at = 0; at < path.size();) {
      const std::size_t end = std::min(path.find('/', at), path.size());
      if (end > at) names.push_back(path.substr(at, end - at));
      at = end + 1;
    }
    return names;
  }

  /// Its path, if that leads to it.
  static std::string working_folder() {
    std::error_code error;
    const std::string path = std::filesystem::current_path(error).string();
    return !error && std::filesystem::equivalent(path, ".", error) && !error ? path : ".";
  }

  /// Its names come next. The last one of what ends with a slash is a folder.
  void push(const std::string& path) {
    if (rest_.empty() && path.ends_with('/')) rest_.emplace_back(".");
    const std::vector<std::string> names = names_of(path);
    rest_.insert(rest_.end(), names.rbegin(), names.rend());
  }

  void begin_at(const char* folder) {
    folders_.clear();
    enter(Opened(::open(folder, O_PATH | O_DIRECTORY | O_CLOEXEC)), false);
  }

  void enter(Opened opened, bool is_planted) {
    Status status{};
    if (opened.number() < 0 || ::fstat(opened.number(), &status) != 0) {
      error_ = errno;
    } else {
      folders_.push_back({std::move(opened), status.st_uid, (status.st_mode & S_IWOTH) != 0, is_planted});
    }
  }

  void step() {
    const std::string name = std::move(rest_.back());
    rest_.pop_back();
    const bool is_last = rest_.empty();
    if (is_last) name_ = name;
    if (name == "." || name == "..") {
      if (name == ".." && folders_.size() > 1) folders_.pop_back();
      if (is_last) name_ = ".";
      return;
    }
    const Folder& around = folders_.back();
    Status status{};
    // Folders that the system mounts when somebody enters them are not mounted by O_PATH.
    if (!is_last) ::fstatat(around.opened.number(), (name + "/.").c_str(), &status, 0);
    Opened there(::openat(around.opened.number(), name.c_str(), O_PATH | O_NOFOLLOW | O_CLOEXEC));
    if (there.number() < 0 || ::fstat(there.number(), &status) != 0) {
      if (!is_last || errno != ENOENT) error_ = errno;
      return;
    }
    const bool is_planted = is_of_another(around, status.st_uid);
    const bool is_link = S_ISLNK(status.st_mode);
    if (is_planted && (is_link || (is_last && (around.all_can_write || !S_ISREG(status.st_mode))))) return tell(around, status.st_mode, is_last);
    if (is_link) return follow(there, is_last);
    if (!is_last) enter(std::move(there), is_planted);
  }

  static bool is_of_another(const Folder& around, uid_t owner) {
    if (owner == ::geteuid() || owner == 0) return false;
    return around.is_planted || (around.all_can_write && owner != around.owner);
  }

  void tell(const Folder& around, mode_t mode, bool is_last) {
    const char* what = S_ISLNK(mode) ? "a link" : S_ISREG(mode) ? "a file" : S_ISDIR(mode) ? "a folder" : "a pipe or device";
    planted_ = (is_last ? "" : "below ") + std::string(what) + " of another user in a folder that " +
               (around.all_can_write ? "all can write" : "stands where all can write");
  }

  void follow(const Opened& link, bool is_last) {
    constexpr int most_links = 40;  // as the system follows
    struct statfs system {};
    is_of_proc_ = is_last && ::fstatfs(link.number(), &system) == 0 && system.f_type == PROC_SUPER_MAGIC;
    if (is_of_proc_) return;  // it is an open file, which may have no path
    char target[PATH_MAX];
    const ssize_t size = ::readlinkat(link.number(), "", target, sizeof target);
    if (size <= 0 || ++links_ > most_links) {
      error_ = size < 0 ? errno : size == 0 ? ENOENT : ELOOP;
      return;
    }
    push({target, static_cast<std::size_t>(size)});
    if (target[0] == '/') begin_at("/");
  }

  std::vector<Folder> folders_;    // from the first on
  std::vector<std::string> rest_;  // names that are still to come, the next one last
  std::string name_;
  bool is_of_proc_ = false;
  int links_ = 0, error_ = 0;
  std::optional<std::string> planted_;
};

/// @throws WriteError
Place place_to_write(const std::string& path) {
  Place place(path);
  if (place.planted()) throw WriteError(fmt::format("{}: cannot be written: it is {}", path, *place.planted()));
  if (place.error() != 0) fail(path, place.error());
  return place;
}

/// Whether another program has the lock of those that write to a file. Who may only read it could have one that keeps others from
/// writing, and stop them: that one counts for nothing.
bool is_taken_by_a_writer(int file) {
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  if (::fcntl(file, F_OFD_SETLK, &lock) == 0 || (errno != EAGAIN && errno != EACCES)) return false;
  lock.l_type = F_RDLCK;  // only locks of writers are in its way
  return ::fcntl(file, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
}

}  // namespace

std::optional<std::string> planted_at(const std::string& path) { return Place(path).planted(); }

int open_alone(const std::string& path, int flags) {
  flags |= O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC;
  int file = place_to_write(path).open(flags | O_EXCL);
  if (file < 0 && errno == EEXIST) file = place_to_write(path).open(flags);
  if (file < 0) fail(path, errno);
  Status status{};
  if (::fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) return file;
  const bool is_taken = is_taken_by_a_writer(file);
  if (!is_taken && ::ftruncate(file, 0) == 0) return file;
  const int error = errno;
  ::close(file);
  if (!is_taken) fail(path, error);
  throw WriteError(path + ": cannot be written: another program writes to it; name another file");
}

bool has_name(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) != 0 || status.st_nlink > 0;
}

std::optional<std::string> loss_of(int descriptor, bool had_name, std::uint64_t size) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  if (had_name && status.st_nlink == 0) return "was removed while it was written, and is lost";
  const auto now = static_cast<std::uint64_t>(status.st_size);
  if (now >= size) return std::nullopt;
  return fmt::format("was shortened by another program while it was written: {} bytes of {} are lost", size - now, size);
}

OutputFile::OutputFile(std::string path) : path_(std::move(path)) {
  descriptor_ = path_ == "-" ? ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3) : open_alone(path_);
  if (descriptor_ < 0) fail(path_, errno);
  has_name_ = has_name(descriptor_);
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::written() {
  if (buffer_.size() >= full_buffer) flush();
}

void OutputFile::close() {
  if (descriptor_ < 0) return;
  flush();
  const auto loss = loss_of(descriptor_, has_name_, size_);
  // Some file systems report a full disk only here.
  if (::close(std::exchange(descriptor_, -1)) != 0) fail(path_, errno);
  if (loss) throw WriteError(fmt::format("{}: {}", path_, *loss));
}

void OutputFile::flush() {
  if (descriptor_ < 0) return;  // it was closed by an error that was reported
  const char* next = buffer_.data();
  std::size_t left = buffer_.size();
  while (left > 0) {
    const ssize_t count = ::write(descriptor_, next, left);
    if (count < 0) {
      if (errno == EINTR) continue;
      const int error = errno;
      buffer_.clear();
      ::close(std::exchange(descriptor_, -1));
      fail(path_, error);
    }
    next += count;
    left -= static_cast<std::size_t>(count);
    size_ += static_cast<std::uint64_t>(count);
  }
  buffer_.clear();
}

}  // namespace ziggurat::recording
