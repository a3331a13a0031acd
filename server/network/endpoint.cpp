// SPDX-License-Identifier: MIT
#include "network/endpoint.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <charconv>
#include <cstring>
#include <string_view>

namespace ziggurat::network {
namespace {

constexpr std::string_view ipc = "ipc://";
constexpr std::string_view tcp = "tcp://";
constexpr std::size_t max_ipc_path = sizeof(sockaddr_un::sun_path) - 1;

/// Not abstract, and not `*`, for which the listener makes a folder.
bool is_file(std::string_view path) { return path[0] != '@' && path != "*"; }

void check_ipc(const std::string& endpoint, const std::string& path) {
  if (path.empty() || path == "@") {
    throw EndpointError(
        fmt::format("{}: no path; write for example ipc:///run/user/1000/arena", endpoint));
  }
  if (path.size() > max_ipc_path) {
    throw EndpointError(fmt::format("{}: the path has {} bytes; {} are the system's limit",
                                    endpoint, path.size(), max_ipc_path));
  }
  if (!is_file(path)) return;
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return;
  if (!S_ISSOCK(status.st_mode)) {
    throw EndpointError(
        fmt::format("{}: a file is in the way; name a path that is free", endpoint));
  }
  if (is_listening(path)) {
    throw EndpointError(
        fmt::format("{}: another server listens there; name another path", endpoint));
  }
}

bool is_loopback(std::string_view host) {
  if (host == "localhost" || host == "[::1]") return true;
  // Four decimal numbers, the first of them 127.
  unsigned parts[4] = {};
  for (int i = 0; i < 4; ++i) {
    const auto [end, error] = std::from_chars(host.data(), host.data() + host.size(), parts[i]);
    if (error != std::errc{} || parts[i] > 255) return false;
    host.remove_prefix(static_cast<std::size_t>(end - host.data()));
    if (i == 3) break;
    if (host.empty() || host[0] != '.') return false;
    host.remove_prefix(1);
  }
  return host.empty() && parts[0] == 127;
}

void check_tcp(const std::string& endpoint, std::string_view address, bool insecure) {
  const std::size_t colon = address.rfind(':');
  const std::string_view host = address.substr(0, colon);
  const std::string_view port =
      colon == std::string_view::npos ? std::string_view{} : address.substr(colon + 1);
  unsigned number = 0;
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), number);
  const bool is_number =
      error == std::errc{} && end == port.data() + port.size() && number <= 65535;
  if (host.empty() || colon == std::string_view::npos) {
    throw EndpointError(
        fmt::format("{}: not a host and a port; write for example tcp://127.0.0.1:7400", endpoint));
  }
  if (port != "*" && !is_number) {
    throw EndpointError(
        fmt::format("{}: the port is '{}'; it must be a number from 1 to 65535, or '*' or 0 for "
                    "any that is free",
                    endpoint, port));
  }
  if (!insecure && !is_loopback(host)) {
    throw EndpointError(
        fmt::format("{}: not a loopback address: all who reach it could control the robots; use "
                    "tcp://127.0.0.1:{}, protect it with --curve-secret and --curve-clients, or "
                    "allow it with --insecure",
                    endpoint, port));
  }
}

}  // namespace

bool is_listening(const std::string& path) {
  const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket < 0) return false;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  const int result = ::connect(socket, reinterpret_cast<sockaddr*>(&address), sizeof(address));
  const bool listening = result == 0 || errno == EAGAIN;
  ::close(socket);
  return listening;
}

void check_endpoint(const std::string& endpoint, bool insecure) {
  if (endpoint.starts_with(ipc)) {
    check_ipc(endpoint, endpoint.substr(ipc.size()));
  } else if (endpoint.starts_with(tcp)) {
    check_tcp(endpoint, std::string_view(endpoint).substr(tcp.size()), insecure);
  } else {
    throw EndpointError(fmt::format(
        "'{}': not an endpoint; write for example ipc:///path or tcp://127.0.0.1:7400", endpoint));
  }
}

std::string file_of(const std::string& endpoint) {
  if (!endpoint.starts_with(ipc)) return {};
  const std::string path = endpoint.substr(ipc.size());
  return is_file(path) ? path : std::string{};
}

}  // namespace ziggurat::network
