// SPDX-License-Identifier: MIT
#include "network/listener.h"

#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include "network/endpoint.h"

namespace ziggurat::network {
namespace {

constexpr int waiting_connections = 4096;  // until they are accepted; beyond the queue's end the
                                           // kernel lets them try again, after seconds
constexpr int keepalive_idle_s = 30;  // tcp: answered by the peer's kernel, so that a controller
                                      // held in a debugger stays, and a vanished machine does not
constexpr std::string_view path_scheme = "ipc://", address_scheme = "tcp://";

[[noreturn]] void fail(const std::string& endpoint, int error) {
  const auto reason = [&]() -> std::string {
    switch (error) {
      case EADDRINUSE:
        return "the address is taken; another server may listen there";
      case EADDRNOTAVAIL:
      case ENODEV:
        return "this machine has no such address";
      case EACCES:
        return "no permission to listen there";
      case ENOENT:
        return "the folder does not exist";
      default:
        return std::strerror(error);
    }
  };
  throw EndpointError(fmt::format("{}: can't listen: {}", endpoint, reason()));
}

posix::Descriptor open_socket(const std::string& endpoint, int family) {
  posix::Descriptor made(::socket(family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!made.is_open()) fail(endpoint, errno);
  return made;
}

void bind_and_listen(const std::string& endpoint, const posix::Descriptor& socket,
                     const sockaddr* address, socklen_t size) {
  if (::bind(socket.number(), address, size) != 0) fail(endpoint, errno);
  if (::listen(socket.number(), waiting_connections) != 0) fail(endpoint, errno);
}

void set_option(int socket, int level, int option, int value) {
  ::setsockopt(socket, level, option, &value, sizeof value);
}

/// Name of an abstract socket that locks this path until a server listens there; empty if there is
/// no such folder.
std::string lock_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  const std::string folder = slash == std::string::npos ? "." : path.substr(0, slash + 1);
  struct stat status {};
  if (::stat(folder.c_str(), &status) != 0) return {};
  const std::size_t name = std::hash<std::string>{}(path.substr(slash + 1));  // npos + 1 is 0
  return fmt::format("ziggurat-path-{}-{}-{:x}", status.st_dev, status.st_ino, name);
}

/// Locks a path, so that of several servers only one checks the path and then listens there. The
/// lock is held while the descriptor is open. Any user of this machine may hold it, too, so no
/// server waits for long.
posix::Descriptor hold_path(const std::string& path) {
  constexpr int most_tries = 50, between_us = 10'000;
  const std::string lock = lock_of(path);
  posix::Descriptor held(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (!held.is_open() || lock.empty()) return held;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  lock.copy(address.sun_path + 1, sizeof address.sun_path - 1);
  const auto* generic = reinterpret_cast<const sockaddr*>(&address);
  for (int i = 0; ::bind(held.number(), generic, sizeof address) != 0 && i < most_tries; ++i)
    ::usleep(between_us);
  return held;
}

/// Removes the socket of a server that is gone, and nothing else.
void make_way(const std::string& endpoint, const std::string& path) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0) return;
  if (!S_ISSOCK(status.st_mode) || is_listening(path)) fail(endpoint, EADDRINUSE);
  ::unlink(path.c_str());
}

struct Address {
  sockaddr_storage storage{};
  socklen_t size = 0;
};

/// Address of a host given in numbers; none if it is a name.
std::optional<Address> numeric_address(const char* host, const std::string& port) {
  addrinfo hints{};
  hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV | AI_PASSIVE;
  hints.ai_socktype = SOCK_STREAM;
  if (host == nullptr) hints.ai_family = AF_INET;
  addrinfo* found = nullptr;
  if (::getaddrinfo(host, port.c_str(), &hints, &found) != 0) return std::nullopt;
  Address address;
  std::memcpy(&address.storage, found->ai_addr, found->ai_addrlen);
  address.size = found->ai_addrlen;
  ::freeaddrinfo(found);
  return address;
}

/// The first IPv4 address of a network interface; none if there is no such interface.
std::optional<Address> address_of_interface(std::string_view name, const std::string& port) {
  ifaddrs* all = nullptr;
  if (::getifaddrs(&all) != 0) return std::nullopt;
  const std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)> owner(all, ::freeifaddrs);
  for (const ifaddrs* each = all; each != nullptr; each = each->ifa_next) {
    const bool is_it =
        each->ifa_addr != nullptr && each->ifa_addr->sa_family == AF_INET && name == each->ifa_name;
    if (!is_it) continue;
    auto address = numeric_address(nullptr, port);
    if (!address) return std::nullopt;
    reinterpret_cast<sockaddr_in&>(address->storage).sin_addr =
        reinterpret_cast<const sockaddr_in*>(each->ifa_addr)->sin_addr;
    return address;
  }
  return std::nullopt;
}

std::optional<Address> resolve(std::string host, std::string port) {
  if (port == "*") port = "0";
  if (host == "*") return numeric_address(nullptr, port);
  if (host == "localhost") host = "127.0.0.1";
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  if (auto address = numeric_address(host.c_str(), port)) return address;
  return address_of_interface(host, port);
}

/// "tcp://host:port" of a socket that listens.
std::string name_of(const posix::Descriptor& socket) {
  Address address;
  address.size = sizeof address.storage;
  auto* generic = reinterpret_cast<sockaddr*>(&address.storage);
  ::getsockname(socket.number(), generic, &address.size);
  char host[NI_MAXHOST], port[NI_MAXSERV];
  ::getnameinfo(generic, address.size, host, sizeof host, port, sizeof port,
                NI_NUMERICHOST | NI_NUMERICSERV);
  const bool is_new = address.storage.ss_family == AF_INET6;
  return is_new ? fmt::format("tcp://[{}]:{}", host, port) : fmt::format("tcp://{}:{}", host, port);
}

}  // namespace

Listener::Listener(const std::string& endpoint) {
  if (endpoint.starts_with(path_scheme)) {
    listen_at_path(endpoint, endpoint.substr(path_scheme.size()));
  } else {
    listen_at_address(endpoint, endpoint.substr(address_scheme.size()));
  }
}

Listener::~Listener() {
  // While it listens, no other server takes a path.
  if (!file_.empty() && descriptor_.is_open()) ::unlink(file_.c_str());
  if (!folder_.empty() && descriptor_.is_open()) ::rmdir(folder_.c_str());
}

void Listener::listen_at_path(const std::string& endpoint, std::string path) {
  if (path == "*") {  // any place
    std::string pattern = "/tmp/ziggurat-XXXXXX";
    if (::mkdtemp(pattern.data()) == nullptr) fail(endpoint, errno);
    folder_ = pattern;
    path = folder_ + "/socket";
  }
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  auto size = static_cast<socklen_t>(sizeof address);
  const bool is_abstract = path[0] == '@';
  posix::Descriptor held;
  if (is_abstract) {
    address.sun_path[0] = '\0';
    size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + path.size());
  } else {
    held = hold_path(path);
    make_way(endpoint, path);
  }
  posix::Descriptor made = open_socket(endpoint, AF_UNIX);
  bind_and_listen(endpoint, made, reinterpret_cast<const sockaddr*>(&address), size);
  if (!is_abstract) file_ = path;
  endpoint_ = std::string(path_scheme) + path;
  descriptor_ = std::move(made);
}

void Listener::listen_at_address(const std::string& endpoint, const std::string& address) {
  const std::size_t colon = address.rfind(':');
  const auto found = resolve(address.substr(0, colon), address.substr(colon + 1));
  if (!found) fail(endpoint, ENODEV);
  posix::Descriptor made = open_socket(endpoint, found->storage.ss_family);
  set_option(made.number(), SOL_SOCKET, SO_REUSEADDR, 1);
  if (found->storage.ss_family == AF_INET6) {
    set_option(made.number(), IPPROTO_IPV6, IPV6_V6ONLY, 0);
  }
  bind_and_listen(endpoint, made, reinterpret_cast<const sockaddr*>(&found->storage), found->size);
  endpoint_ = name_of(made);
  is_tcp_ = true;
  descriptor_ = std::move(made);
}

posix::Descriptor Listener::accept() const {
  posix::Descriptor client(::accept4(number(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (client.is_open() && is_tcp_) {
    set_option(client.number(), IPPROTO_TCP, TCP_NODELAY, 1);
    set_option(client.number(), SOL_SOCKET, SO_KEEPALIVE, 1);
    set_option(client.number(), IPPROTO_TCP, TCP_KEEPIDLE, keepalive_idle_s);
  }
  return client;
}

}  // namespace ziggurat::network
