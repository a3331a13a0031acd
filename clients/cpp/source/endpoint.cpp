#include "plain_endpoint.h"

#include <netdb.h>
#include <pthread.h>
#include <sys/un.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

namespace ziggurat {
namespace {

constexpr std::string_view ipc = "ipc://", tcp = "tcp://";

bool is_alphanumeric(char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

bool is_made_of(std::string_view text, std::string_view others) {
  return !text.empty() && std::ranges::all_of(text, [&](char c) { return is_alphanumeric(c) || others.find(c) != others.npos; });
}

bool is_in_brackets(std::string_view host) {
  return host.size() > 2 && host.starts_with('[') && host.ends_with(']') &&
         is_made_of(host.substr(1, host.size() - 2), ".:%-_");
}

bool is_port(std::string_view text) {
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  return error == std::errc{} && end == text.data() + text.size() && port > 0;
}

bool is_short_path(std::string_view text) {
  return !text.empty() && text[0] != '@' && text[0] != '*' && text.size() < sizeof(sockaddr_un::sun_path);
}

SocketAddress address_of_path(const std::string& path) {
  SocketAddress address;
  auto& local = reinterpret_cast<sockaddr_un&>(address.bytes);
  local.sun_family = AF_UNIX;
  std::ranges::copy(path, local.sun_path);
  address.size = sizeof(sockaddr_un);
  return address;
}

/// The first address of a host, as libzmq takes it: version 6 of the internet's protocol for what is in brackets.
/// @param flags  of getaddrinfo()
SocketAddress look_up(std::string host, const std::string& port, int flags) {
  addrinfo wanted{};
  wanted.ai_family = AF_INET;
  wanted.ai_socktype = SOCK_STREAM;
  wanted.ai_flags = flags | AI_NUMERICSERV;
  if (host.starts_with('[')) {
    host = host.substr(1, host.size() - 2);
    wanted.ai_family = AF_INET6;
    wanted.ai_flags |= AI_V4MAPPED;
  }
  SocketAddress address;
  addrinfo* found = nullptr;
  if (::getaddrinfo(host.c_str(), port.c_str(), &wanted, &found) != 0) return address;
  std::memcpy(&address.bytes, found->ai_addr, found->ai_addrlen);
  address.size = found->ai_addrlen;
  ::freeaddrinfo(found);
  return address;
}

/// Runs it on a thread that takes no signals of the program. If there can be none, the task's future says so.
void start_alone(std::packaged_task<SocketAddress()> task) {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  try {
    std::thread(std::move(task)).detach();
  } catch (const std::system_error&) {
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

std::future<SocketAddress> known(SocketAddress address) {
  std::promise<SocketAddress> promise;
  promise.set_value(address);
  return promise.get_future();
}

}  // namespace

void check_endpoint(const std::string& endpoint) {
  const auto refuse = [&](const std::string& why) {
    throw std::invalid_argument("'" + endpoint + "': " + why);
  };
  if (endpoint.starts_with(ipc)) return;
  if (!endpoint.starts_with(tcp))
    refuse("not an endpoint to connect to; write ipc:///path or tcp://host:port");
  const std::size_t colon = endpoint.rfind(':');
  if (colon <= tcp.size()) refuse("not a host and a port; write tcp://host:port");
  const std::string port = endpoint.substr(colon + 1);
  if (!is_port(port)) refuse("the port is '" + port + "'; it must be a number from 1 to 65535");
}

bool has_unknown_host(const std::string& endpoint) {
  SessionOptions options;
  options.endpoint = endpoint;
  const auto found = PlainEndpoint::of(options);
  if (!found || found->is_path()) return false;
  std::future<SocketAddress> address = found->address();
  try {
    return address.wait_for(std::chrono::seconds{1}) == std::future_status::ready && address.get().size == 0;
  } catch (const std::future_error&) {
    return false;  // there was no thread to look it up
  }
}

PlainEndpoint::PlainEndpoint(std::string text, std::string host, std::string port)
    : text_(std::move(text)), host_(std::move(host)), port_(std::move(port)) {}

std::optional<PlainEndpoint> PlainEndpoint::of(const SessionOptions& options) {
  const std::string& text = options.endpoint;
  if (!options.server_key.empty() || !options.curve_secret.empty()) return std::nullopt;
  if (text.starts_with(ipc)) {
    std::string path = text.substr(ipc.size());
    return is_short_path(path) ? std::optional(PlainEndpoint(text, std::move(path), {})) : std::nullopt;
  }
  const std::size_t colon = text.rfind(':');
  if (!text.starts_with(tcp) || colon < tcp.size()) return std::nullopt;
  std::string host = text.substr(tcp.size(), colon - tcp.size()), port = text.substr(colon + 1);
  if (!is_port(port) || !(is_in_brackets(host) || is_made_of(host, ".-_"))) return std::nullopt;
  return PlainEndpoint(text, std::move(host), std::move(port));
}

std::future<SocketAddress> PlainEndpoint::address() const {
  if (is_path()) return known(address_of_path(host_));
  const SocketAddress numeric = look_up(host_, port_, AI_NUMERICHOST);
  if (numeric.size > 0) return known(numeric);
  std::packaged_task<SocketAddress()> task([host = host_, port = port_] { return look_up(host, port, 0); });
  std::future<SocketAddress> address = task.get_future();
  start_alone(std::move(task));
  return address;
}

}  // namespace ziggurat
