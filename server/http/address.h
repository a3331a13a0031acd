// SPDX-License-Identifier: MIT
#pragma once
// Address of a port, and the host names that clients may call it.

#include <cstdint>
#include <string>
#include <string_view>

namespace ziggurat::http {

struct Address {
  std::string host;
  std::uint16_t port = 0;  ///< 0: any free one
};

/// @param value  HOST:PORT; HOST may be in brackets, and `*` means all addresses of this machine
/// @throws text::UsageError that names the option
Address to_address(std::string_view option, const std::string& value);

/// HOST of `Host: HOST:PORT`; an IPv6 address stays in brackets.
std::string_view without_port(std::string_view host);

/// Only programs of this machine can reach it.
bool is_loopback(std::string_view host);

/// Whether the value of `Host` is a name that no website can make mean this machine: a number,
/// `localhost` or the port's own name. Without `Host`, as old programs ask, it is.
/// @param own  in any letters
bool allows_host(std::string_view own, std::string_view called);

}  // namespace ziggurat::http
