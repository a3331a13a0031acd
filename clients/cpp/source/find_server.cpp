// SPDX-License-Identifier: MIT
// The server that runs on this machine: `ziggurat serve` without --endpoint listens in a folder of
// its user.

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "ziggurat/session.h"

namespace ziggurat {
namespace {

namespace fs = std::filesystem;

/// Folders in which servers of this user listen (docs/protocol.md, T11).
std::vector<fs::path> folders() {
  std::vector<fs::path> found;
  const char* const runtime = std::getenv("XDG_RUNTIME_DIR");
  if (runtime != nullptr && runtime[0] == '/') found.push_back(fs::path(runtime) / "ziggurat");
  found.push_back("/tmp/ziggurat-" + std::to_string(::geteuid()));
  return found;
}

/// Whether no other user can have put anything there.
bool is_private(const fs::path& folder) {
  struct stat status {};
  return ::lstat(folder.c_str(), &status) == 0 && S_ISDIR(status.st_mode) &&
         status.st_uid == ::geteuid() && (status.st_mode & 077) == 0;
}

/// Whether a server listens there: a socket's file may be left over.
bool is_alive(const fs::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string text = path.string();
  if (text.size() >= sizeof address.sun_path) return false;
  std::memcpy(address.sun_path, text.c_str(), text.size() + 1);
  const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket < 0) return false;
  const int result = ::connect(socket, reinterpret_cast<sockaddr*>(&address), sizeof address);
  const bool is_there = result == 0 || errno == EAGAIN;
  ::close(socket);
  return is_there;
}

}  // namespace

std::string find_server() {
  std::vector<std::string> endpoints;
  for (const fs::path& folder : folders()) {
    if (!endpoints.empty() || !is_private(folder)) continue;
    std::error_code error;
    for (auto it = fs::directory_iterator(folder, error); !error && it != fs::directory_iterator();
         it.increment(error)) {
      if (is_alive(it->path())) endpoints.push_back("ipc://" + it->path().string());
    }
  }
  if (endpoints.size() == 1) return endpoints.front();
  if (endpoints.empty()) {
    throw std::invalid_argument(
        "no server of this user runs here; start one with 'ziggurat serve SCENE', or name the "
        "endpoint "
        "of another, which it prints");
  }
  std::ranges::sort(endpoints);
  std::string text =
      std::to_string(endpoints.size()) + " servers run here; name the endpoint of one: ";
  for (const std::string& each : endpoints) text += (&each == &endpoints[0] ? "" : ", ") + each;
  throw std::invalid_argument(text);
}

}  // namespace ziggurat
