// SPDX-License-Identifier: MIT
#include "view/access.h"

#include <fmt/format.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <system_error>

#include "http/address.h"
#include "text/numbers.h"

namespace ziggurat::view {
namespace {

constexpr std::string_view letters =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
constexpr std::size_t least_token = 16, longest_token = 256;  // [characters]

/// In a time that does not depend on where they differ.
bool equal(std::string_view a, std::string_view b) {
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    difference |= static_cast<unsigned>(a[i] ^ b[i]);
  }
  return difference == 0;
}

}  // namespace

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

Permission permission_of(const Rules& rules, const RequestHead& head) {
  if (!rules.any_host && !http::allows_host(rules.host, head.host)) return Permission::refused;
  if (const auto token = token_in(head.target)) {
    return equal(*token, rules.token) ? Permission::steer : Permission::refused;
  }
  if (rules.look_needs_token) return Permission::refused;
  const bool is_own_page = !head.origin || *head.origin == fmt::format("http://{}", head.host);
  return is_own_page ? Permission::look : Permission::refused;
}

}  // namespace ziggurat::view
