// SPDX-License-Identifier: MIT
#include "http/address.h"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>

#include "text/numbers.h"

namespace ziggurat::http {
namespace {

std::string_view without_brackets(std::string_view host) {
  const bool has = host.size() > 2 && host.front() == '[' && host.back() == ']';
  return has ? host.substr(1, host.size() - 2) : host;
}

bool is_number(std::string_view host) {
  const std::string text(without_brackets(host));
  std::array<std::uint8_t, 16> address;
  return ::inet_pton(AF_INET, text.c_str(), address.data()) == 1 ||
         ::inet_pton(AF_INET6, text.c_str(), address.data()) == 1;
}

bool is_same_name(std::string_view a, std::string_view b) {
  return std::ranges::equal(
      a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

}  // namespace

std::string_view without_port(std::string_view host) {
  const std::size_t colon = host.rfind(':');
  if (colon == std::string_view::npos) return host;
  const bool is_port = host.find_first_not_of("0123456789", colon + 1) == std::string_view::npos;
  return is_port ? host.substr(0, colon) : host;
}

Address to_address(std::string_view option, const std::string& value) {
  const std::size_t colon = value.rfind(':');
  if (colon == std::string::npos || colon == 0) {
    throw text::UsageError(
        fmt::format("{} is '{}'; write host:port, as 127.0.0.1:8765", option, value));
  }
  const auto port = text::to_integer(std::string(option), value.substr(colon + 1));
  if (port > 65535) {
    throw text::UsageError(
        fmt::format("{}: port {} is too large; ports are 0 to 65535", option, port));
  }
  const std::string_view host = without_brackets(std::string_view(value).substr(0, colon));
  return {host == "*" ? "0.0.0.0" : std::string(host), static_cast<std::uint16_t>(port)};
}

bool is_loopback(std::string_view host) {
  host = without_brackets(host);
  return host == "localhost" || host == "::1" || (host.starts_with("127.") && is_number(host));
}

bool allows_host(std::string_view own, std::string_view called) {
  if (called.empty()) return true;
  const std::string_view name = without_port(called);
  return is_same_name(name, "localhost") || is_number(name) || is_same_name(name, own);
}

}  // namespace ziggurat::http
