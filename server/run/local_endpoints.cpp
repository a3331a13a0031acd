// SPDX-License-Identifier: MIT
#include "run/local_endpoints.h"

#include <fmt/format.h>
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

/// Makes the folder, unless it is there. Whether only this user can enter it.
bool make_private(const std::string& folder) {
  ::mkdir(folder.c_str(), 0700);
  struct stat status {};
  return ::lstat(folder.c_str(), &status) == 0 && S_ISDIR(status.st_mode) &&
         status.st_uid == ::geteuid() && (status.st_mode & 077) == 0;
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
    if (path.size() > longest_path || !make_private(folder)) continue;
    remove_left_sockets(folder);
    return "ipc://" + path;
  }
  return any();
}

}  // namespace ziggurat::run
