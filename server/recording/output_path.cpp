#include "recording/output_path.h"

#include <fcntl.h>
#include <linux/magic.h>
#include <sys/stat.h>
#include <sys/vfs.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <filesystem>
#include <system_error>

namespace ziggurat::recording {
namespace {

using Status = struct stat;

std::vector<std::string> names_of(const std::string& path) {
  std::vector<std::string> names;
  for (std::size_t at = 0; at < path.size();) {
    const std::size_t end = std::min(path.find('/', at), path.size());
    if (end > at) names.push_back(path.substr(at, end - at));
    at = end + 1;
  }
  return names;
}

/// Its path, if that leads to it.
std::string working_folder() {
  std::error_code error;
  const std::string path = std::filesystem::current_path(error).string();
  return !error && std::filesystem::equivalent(path, ".", error) && !error ? path : ".";
}

}  // namespace

OutputPath::OutputPath(const std::string& path) {
  const std::string begin = path.starts_with('/') ? "/" : working_folder();
  push_names(path);
  if (begin != ".") push_names(begin);
  start_at(begin == "." ? "." : "/");
  while (error_ == 0 && !planted_ && !remaining_.empty()) step();
}

int OutputPath::open(int flags) const {
  return ::openat(folders_.back().opened.number(), name_.c_str(), flags | (is_of_proc_ ? 0 : O_NOFOLLOW), 0666);
}

void OutputPath::remove() const { ::unlinkat(folders_.back().opened.number(), name_.c_str(), 0); }

/// Its names come next. The last one of what ends with a slash is a folder.
void OutputPath::push_names(const std::string& path) {
  if (remaining_.empty() && path.ends_with('/')) remaining_.emplace_back(".");
  const std::vector<std::string> names = names_of(path);
  remaining_.insert(remaining_.end(), names.rbegin(), names.rend());
}

void OutputPath::start_at(const char* folder) {
  folders_.clear();
  enter(posix::Descriptor(::open(folder, O_PATH | O_DIRECTORY | O_CLOEXEC)), false);
}

void OutputPath::enter(posix::Descriptor opened, bool is_planted) {
  Status status{};
  if (opened.number() < 0 || ::fstat(opened.number(), &status) != 0) {
    error_ = errno;
  } else {
    folders_.push_back({std::move(opened), status.st_uid, (status.st_mode & S_IWOTH) != 0, is_planted});
  }
}

void OutputPath::step() {
  const std::string name = std::move(remaining_.back());
  remaining_.pop_back();
  const bool is_last = remaining_.empty();
  if (is_last) name_ = name;
  if (name == "." || name == "..") {
    if (name == ".." && folders_.size() > 1) folders_.pop_back();
    if (is_last) name_ = ".";
    return;
  }
  const Folder& parent = folders_.back();
  Status status{};
  // Folders that the system mounts when somebody enters them are not mounted by O_PATH.
  if (!is_last) ::fstatat(parent.opened.number(), (name + "/.").c_str(), &status, 0);
  posix::Descriptor there(::openat(parent.opened.number(), name.c_str(), O_PATH | O_NOFOLLOW | O_CLOEXEC));
  if (there.number() < 0 || ::fstat(there.number(), &status) != 0) {
    if (!is_last || errno != ENOENT) error_ = errno;
    return;
  }
  const bool is_planted = is_foreign(parent, status.st_uid);
  const bool is_link = S_ISLNK(status.st_mode);
  if (is_planted && (is_link || (is_last && (parent.all_can_write || !S_ISREG(status.st_mode))))) return reject(parent, status.st_mode, is_last);
  if (is_link) return follow(there, is_last);
  if (!is_last) enter(std::move(there), is_planted);
}

bool OutputPath::is_foreign(const Folder& parent, uid_t owner) {
  if (owner == ::geteuid() || owner == 0) return false;
  return parent.is_planted || (parent.all_can_write && owner != parent.owner);
}

void OutputPath::reject(const Folder& parent, mode_t mode, bool is_last) {
  const char* what = S_ISLNK(mode) ? "a link" : S_ISREG(mode) ? "a file" : S_ISDIR(mode) ? "a folder" : "a pipe or device";
  planted_ = (is_last ? "" : "below ") + std::string(what) + " of another user in a folder that " +
             (parent.all_can_write ? "all can write" : "stands where all can write");
}

void OutputPath::follow(const posix::Descriptor& link, bool is_last) {
  constexpr int most_links = 40;  // as the system follows
  struct statfs system {};
  is_of_proc_ = is_last && ::fstatfs(link.number(), &system) == 0 && system.f_type == PROC_SUPER_MAGIC;
  if (is_of_proc_) return;  // it is an open file, which may have no path
  char target[PATH_MAX];
  const ssize_t size = ::readlinkat(link.number(), "", target, sizeof target);
  if (size <= 0 || ++followed_links_ > most_links) {
    error_ = size < 0 ? errno : size == 0 ? ENOENT : ELOOP;
    return;
  }
  push_names({target, static_cast<std::size_t>(size)});
  if (target[0] == '/') start_at("/");
}

}  // namespace ziggurat::recording
