#include "view/access.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <system_error>

#include "text/numbers.h"

namespace ziggurat::view {
namespace {

constexpr std::string_view letters =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
constexpr std::size_t least_token = 16, longest_token = 256;  // [characters]

std::string_view without_brackets(std::string_view host) {
  const bool has = host.size() > 2 && host.front() == '[' && host.back() == ']';
  return has ? host.substr(1, host.size() - 2) : host;
}

std::string_view without_port(std::string_view host) {
  const std::size_t colon = host.rfind(':');
  if (colon == std::string_view::npos || host.find(']', colon) != std::string_view::npos) {
    return host;
  }
  return host.substr(0, colon);
}

bool is_number(std::string_view host) {
  const std::string text(without_brackets(host));
  std::array<std::uint8_t, 16> address;
  return ::inet_pton(AF_INET, text.c_str(), address.data()) == 1 ||
         ::inet_pton(AF_INET6, text.c_str(), address.data()) == 1;
}

/// In a time that does not depend on where they differ.
bool equal(std::string_view a, std::string_view b) {
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    difference |= static_cast<unsigned>(a[i] ^ b[i]);
  }
  return difference == 0;
}

}  // namespace

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
  return {std::string(without_brackets(std::string_view(value).substr(0, colon))),
          static_cast<std::uint16_t>(port)};
}

bool is_loopback(std::string_view host) {
  host = without_brackets(host);
  return host == "localhost" || host == "::1" || (host.starts_with("127.") && is_number(host));
}

std::string random_token() {
  std::array<std::uint8_t, 22> random;
  if (::getrandom(random.data(), random.size(), 0) != static_cast<ssize_t>(random.size())) {
    throw std::system_error(errno, std::generic_category(), "getrandom");
  }
  std::string token;
  for (const std::uint8_t byte : random) token += letters[byte % letters.size()];
  return token;
}

void check_token(const std::string& token) {
  const bool plain = token.find_first_not_of(letters) == std::string::npos;
  if (plain && token.size() >= least_token && token.size() <= longest_token) return;
  throw text::UsageError(
      fmt::format("--view-token must have {} to {} characters of A-Z a-z 0-9 - _; it has {}{}",
                  least_token, longest_token, token.size(), plain ? "" : ", and others"));
}

bool allows_host(const Rules& rules, std::string_view host) {
  if (rules.any_host || host.empty()) return true;  // only old programs leave it out
  const std::string_view name = without_port(host);
  return name == "localhost" || is_number(name) || name == rules.host;
}

std::optional<std::string> token_in(std::string_view target) {
  const std::size_t question = target.find('?');
  if (question == std::string_view::npos) return std::nullopt;
  std::string_view query = target.substr(question + 1);
  while (!query.empty()) {
    const std::string_view part = query.substr(0, query.find('&'));
    constexpr std::string_view name = "token=";
    if (part.starts_with(name)) return std::string(part.substr(name.size()));
    query = part.size() == query.size() ? std::string_view() : query.substr(part.size() + 1);
  }
  return std::nullopt;
}

Access access_of(const Rules& rules, const Asker& asker) {
  if (!allows_host(rules, asker.host)) return Access::refused;
  if (const auto token = token_in(asker.target)) {
    return equal(*token, rules.token) ? Access::steer : Access::refused;
  }
  if (rules.look_needs_token) return Access::refused;
  const bool is_own_page = !asker.origin || *asker.origin == fmt::format("http://{}", asker.host);
  return is_own_page ? Access::look : Access::refused;
}

}  // namespace ziggurat::view
