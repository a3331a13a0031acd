// SPDX-License-Identifier: MIT
#include "gallery/gallery.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include "gallery/pictures.h"
#include "gallery/ports.h"

namespace ziggurat::gallery {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_kept = 1000;  // pictures of all galleries
constexpr int most_calls = 1200;         // of go_on(), until a picture is given up: two minutes
constexpr int run_patience_ms = 3000;    // for a run to end, before SIGTERM

http::Answer text(unsigned status, std::string sentence) {
  return {status, http::Answer().type, {}, std::move(sentence) + "\n"};
}

http::Answer html(std::string body) {
  return {200, "text/html; charset=utf-8", {}, std::move(body)};
}

/// @param port  where it is; 0: here
http::Answer go_to(std::string place, std::uint16_t port = 0) {
  http::Answer answer = text(303, "It is at " + place);
  answer.location = std::move(place);
  answer.port = port;
  return answer;
}

/// A whole number below a limit, and nothing else.
std::optional<std::size_t> number_in(std::string_view text, std::size_t limit) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_whole = error == std::errc() && end == text.data() + text.size();
  return is_whole && number < limit ? std::optional(number) : std::nullopt;
}

bool is_same(std::string_view a, std::string_view b) {  // takes as long wherever they differ
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    difference |= static_cast<unsigned>(a[i] ^ b[i]);
  return difference == 0;
}

}  // namespace

Gallery::Gallery(Settings settings)
    : settings_(std::move(settings)),
      scenes_(scenes_below(settings_.folder)),
      cache_(cache_folder()),
      path_("/" + settings_.token + "/"),
      pictures_(scenes_.size(), Picture::awaited) {
  std::error_code error;
  fs::create_directories(cache_, error);
  if (error) pictures_.assign(scenes_.size(), Picture::missing);
  for (std::size_t i = 0; i < scenes_.size() && !error; ++i) {
    if (fs::exists(picture_file(cache_, scenes_[i].file), error)) pictures_[i] = Picture::there;
    error.clear();
  }
}

http::Answer Gallery::answer(std::string_view path) {
  const bool has_token =
      path.size() >= path_.size() && is_same(path.substr(0, path_.size()), path_);
  if (!has_token) return text(403, "403: open the address that 'ziggurat view' printed.");
  path.remove_prefix(path_.size());
  const auto slash = path.find('/');
  const std::string_view what = path.substr(0, slash);
  const std::string_view rest =
      slash == std::string_view::npos ? std::string_view() : path.substr(slash + 1);
  const std::lock_guard lock(mutex_);
  if (path.empty()) return page();
  if (what == "picture") return picture(rest);
  if (what == "run") return run(rest);
  if (path == "wait") return wait();
  return text(404, "404: there are no other pages here.");
}

http::Answer Gallery::page() {
  return html(gallery_page(settings_.folder, scenes_, pictures_, path_));
}

http::Answer Gallery::picture(std::string_view number) {
  const auto scene = number_in(number, scenes_.size());
  if (!scene) return text(404, "404: there is no such picture.");
  std::ifstream file(picture_file(cache_, scenes_[*scene].file), std::ios::binary);
  if (!file) return text(404, "404: it is not drawn.");
  return {200, "image/png", {}, {std::istreambuf_iterator<char>(file), {}}};
}

http::Answer Gallery::run(std::string_view number) {
  const auto scene = number_in(number, scenes_.size());
  if (!scene) return text(404, "404: there is no such scene.");
  wanted_ = scene;
  return go_to(path_ + "wait");
}

/// To the page of the run, as soon as it is there.
http::Answer Gallery::wait() {
  if (wanted_)
    return html(notice_page(scenes_[*wanted_].name + " is being started …", path_, true));
  if (!failure_.empty()) return html(notice_page(failure_, path_, false));
  if (!run_) return go_to(path_);
  if (run_->poll()) {
    const std::string sentence =
        fmt::format("The run of {} {}; what it said stands where 'ziggurat view' runs.", run_name_,
                    run_->how_it_ended());
    return html(notice_page(sentence, path_, false));
  }
  if (!is_listening(settings_.address.host, run_port_))
    return html(notice_page(run_name_ + " is being loaded …", path_, true));
  return go_to("/?token=" + settings_.token, run_port_);
}

void Gallery::end_run() {
  std::optional<processes::ChildProcess> former;
  {
    const std::lock_guard lock(mutex_);
    if (!run_) return;
    former.emplace(*std::move(run_));
    run_.reset();
  }
  former->signal(SIGINT);
  processes::end_all({&*former}, run_patience_ms, [] { return false; });
}

void Gallery::start_run() {
  end_run();
  const std::lock_guard lock(mutex_);
  const Scene& scene = scenes_[*std::exchange(wanted_, std::nullopt)];
  run_name_ = scene.name;
  failure_.clear();
  run_port_ = free_port(settings_.address.host);
  processes::Program program;
  program.arguments = {
      settings_.program,   "run",
      scene.file.string(), "--view=" + authority(settings_.address.host, run_port_),
      "--view-token",      settings_.token};
  if (settings_.insecure) program.arguments.emplace_back("--insecure");
  try {
    run_.emplace(program, settings_.guardian);
  } catch (const std::system_error& error) {
    failure_ = fmt::format("{} can't be started: {}.", run_name_, error.code().message());
  }
}

void Gallery::go_on() {
  std::unique_lock lock(mutex_);
  const bool is_wanted = wanted_.has_value();
  lock.unlock();
  if (is_wanted) start_run();
  if (drawing_) finish_drawing();
  if (!drawing_) begin_drawing();
}

void Gallery::finish_drawing() {
  const bool is_over = drawing_->process.poll();
  if (!is_over && ++drawing_->calls < most_calls) return;
  std::error_code error;
  if (is_over && drawing_->process.ended_well()) fs::rename(drawing_->part, drawing_->file, error);
  const bool is_there = fs::exists(drawing_->file, error);
  fs::remove(drawing_->part, error);
  {
    const std::lock_guard lock(mutex_);
    pictures_[drawing_->scene] = is_there ? Picture::there : Picture::missing;
  }
  drawing_.reset();
  forget_old(cache_, most_kept);
}

void Gallery::begin_drawing() {
  std::size_t scene = 0;
  while (scene < pictures_.size() && pictures_[scene] != Picture::awaited) ++scene;
  if (scene == pictures_.size()) return;
  const fs::path file = picture_file(cache_, scenes_[scene].file);
  const fs::path part = cache_ / fmt::format("{}.{}.part.png", file.stem().string(), ::getpid());
  processes::Program program;
  program.arguments = {settings_.program, "render",      scenes_[scene].file.string(),
                       "--out",           part.string(), "--size",
                       "480x270",         "--quiet",     "--without-controllers"};
  program.output = "/dev/null";
  try {
    drawing_.emplace(
        Drawing{scene, processes::ChildProcess(program, settings_.guardian), file, part});
  } catch (const std::system_error&) {
    const std::lock_guard lock(mutex_);
    pictures_[scene] = Picture::missing;
  }
}

void Gallery::close() {
  end_run();
  std::error_code error;
  if (drawing_) fs::remove(drawing_->part, error);
  drawing_.reset();
}

}  // namespace ziggurat::gallery
