// SPDX-License-Identifier: MIT
#pragma once
// Access control of a viewer's port (docs/viewing.md, docs/security.md).

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace ziggurat::view {

/// 128 random bits as 22 characters. @throws std::system_error
std::string random_token();

/// @throws text::UsageError if a token of the user is too short, or has other characters
void check_token(const std::string& token);

struct Rules {
  std::string host;               ///< of the option: a name that clients may call the port
  bool any_host = false;          ///< any name
  bool look_needs_token = false;  ///< also programs and pages of this server need it
  std::string token;
};

/// The parts of a request that decide. Of HTTP, `origin` does not matter.
struct RequestHead {
  std::string_view host;                   ///< of `Host`; empty: there is none
  std::optional<std::string_view> origin;  ///< of `Origin`
  std::string_view target;                 ///< path and query
};

enum class Permission { refused, look, steer };

/// Permission of a WebSocket handshake.
Permission permission_of(const Rules& rules, const RequestHead& head);

/// The value of `token` in a query; nothing: it has none.
std::optional<std::string> token_in(std::string_view target);

}  // namespace ziggurat::view
