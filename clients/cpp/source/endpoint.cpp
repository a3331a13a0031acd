// SPDX-License-Identifier: MIT
#include "endpoint.h"

#include <netdb.h>
#include <sys/socket.h>

#include <charconv>
#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <system_error>

namespace ziggurat {
namespace {

constexpr std::string_view ipc = "ipc://", tcp = "tcp://";

bool is_port(std::string_view text) {
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  return error == std::errc{} && end == text.data() + text.size() && port > 0;
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
  if (!endpoint.starts_with(tcp) || endpoint.starts_with("tcp://[")) return false;
  const std::string host = endpoint.substr(tcp.size(), endpoint.rfind(':') - tcp.size());
  addrinfo wanted{};
  wanted.ai_family = AF_INET;  // as libzmq looks it up
  addrinfo* found = nullptr;
  if (::getaddrinfo(host.c_str(), nullptr, &wanted, &found) != 0) return true;
  ::freeaddrinfo(found);
  return false;
}

}  // namespace ziggurat
