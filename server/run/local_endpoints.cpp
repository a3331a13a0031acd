#include "run/local_endpoints.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <vector>

namespace ziggurat::run {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_path = 107;  // of a socket [bytes]

/// The scene's name as part of a file name: letters, digits, `.`, `_` and `-`, not too many.
std::string short_name(const std::string& scene) {
  constexpr std::size_t most = 24;
  std::string name = fs::path(scene).stem().string().substr(0, most);
  for (char& c : name) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          (c >= '0' && c <= '9') || c == '.' || c == '_' || c == '-';
    if (!is_plain) c = '_';
  }
  return name.empty() || name[0] == '.' ? "scene" : name;
}

/// Opens the folder, which is made if it is not there, and keeps others from removing it until it
/// is closed. Not open unless only this user can enter it.
posix::Descriptor open_private(const std::string& folder) {
  for (;;) {
    ::mkdir(folder.c_str(), 0700);
    posix::Descriptor opened(
        ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
    struct stat here {
    }, there{};
    if (!opened.is_open() || ::fstat(opened.number(), &here) != 0) return {};
    // Before the lock: another user could hold it.
    if (here.st_uid != ::geteuid() || (here.st_mode & 077) != 0) return {};
    if (::flock(opened.number(), LOCK_SH) != 0) return {};
    const bool is_same = ::stat(folder.c_str(), &there) == 0 && here.st_ino == there.st_ino &&
                         here.st_dev == there.st_dev;
    if (is_same) return opened;  // otherwise another server has just removed it
  }
}

/// Sockets whose server was killed, and its guardian with it: the process in their name is gone.
void remove_left_sockets(const std::string& folder) {
  std::error_code error;
  std::vector<fs::path> left;
  for (auto it = fs::directory_iterator(folder, error); !error && it != fs::directory_iterator();
       it.increment(error)) {
    const std::string name = it->path().filename().string();
    const long process = std::strtol(name.substr(name.rfind('-') + 1).c_str(), nullptr, 10);
    const bool is_gone = process > 0 && !fs::exists(fmt::format("/proc/{}", process), error);
    if (is_gone && it->is_socket(error)) left.push_back(it->path());
  }
  for (const fs::path& each : left) fs::remove(each, error);
}

}  // namespace

void LocalEndpoints::release() {
  // No other server uses it.
  if (opened_.is_open() && ::flock(opened_.number(), LOCK_EX | LOCK_NB) == 0) {
    ::rmdir(shared_.c_str());
  }
  opened_ = {};
  folders_.clear();
}

std::string LocalEndpoints::any() {
  return "ipc://" + folders_.emplace_back(guardian_).path() + "/socket";
}

std::string LocalEndpoints::of_server(const std::string& scene) {
  std::vector<std::string> parents;
  const char* const runtime = std::getenv("XDG_RUNTIME_DIR");
  if (runtime != nullptr && runtime[0] == '/')
    parents.push_back(std::string(runtime) + "/ziggurat");
  parents.push_back(fmt::format("/tmp/ziggurat-{}", ::geteuid()));
  for (const std::string& folder : parents) {
    const std::string path = fmt::format("{}/{}-{}", folder, short_name(scene), ::getpid());
    if (path.size() > longest_path) continue;
    opened_ = open_private(folder);
    if (!opened_.is_open()) continue;
    remove_left_sockets(folder);
    shared_ = folder;
    if (guardian_ != nullptr) guardian_->remove_empty_folder(folder);
    return "ipc://" + path;
  }
  return any();
}

}  // namespace ziggurat::run
