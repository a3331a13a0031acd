// SPDX-License-Identifier: MIT
#include "gallery/ports.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <memory>

namespace ziggurat::gallery {
namespace {

constexpr int patience_ms = 300;  // for a connection

struct Found {
  std::unique_ptr<addrinfo, void (*)(addrinfo*)> first{nullptr, ::freeaddrinfo};
  int socket = -1;

  Found(const std::string& host, std::uint16_t port) {
    addrinfo hints{}, *all = nullptr;
    hints.ai_socktype = SOCK_STREAM;
    if (::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &all) != 0) return;
    first.reset(all);
    socket = ::socket(all->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  }
  ~Found() {
    if (socket >= 0) ::close(socket);
  }
  Found(const Found&) = delete;
  Found& operator=(const Found&) = delete;
};

}  // namespace

std::string authority(const std::string& host, std::uint16_t port) {
  const bool is_ipv6 = host.find(':') != std::string::npos;
  return (is_ipv6 ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

std::uint16_t free_port(const std::string& host) {
  const Found found(host, 0);
  if (found.socket < 0) return 0;
  sockaddr_storage bound{};
  socklen_t size = sizeof bound;
  if (::bind(found.socket, found.first->ai_addr, found.first->ai_addrlen) != 0) return 0;
  if (::getsockname(found.socket, reinterpret_cast<sockaddr*>(&bound), &size) != 0) return 0;
  return ntohs(bound.ss_family == AF_INET6 ? reinterpret_cast<sockaddr_in6*>(&bound)->sin6_port
                                           : reinterpret_cast<sockaddr_in*>(&bound)->sin_port);
}

bool is_listening(const std::string& host, std::uint16_t port) {
  const Found found(host, port);
  if (found.socket < 0) return false;
  if (::connect(found.socket, found.first->ai_addr, found.first->ai_addrlen) == 0) return true;
  if (errno != EINPROGRESS) return false;
  pollfd waiting{found.socket, POLLOUT, 0};
  int error = 0;
  socklen_t size = sizeof error;
  return ::poll(&waiting, 1, patience_ms) == 1 &&
         ::getsockopt(found.socket, SOL_SOCKET, SO_ERROR, &error, &size) == 0 && error == 0;
}

}  // namespace ziggurat::gallery
