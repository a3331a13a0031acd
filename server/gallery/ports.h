// SPDX-License-Identifier: MIT
#pragma once
// Ports of this machine, for a program that is started soon.

#include <cstdint>
#include <string>

namespace ziggurat::gallery {

/// As in a URL: `127.0.0.1:8765`, `[::1]:8765`.
std::string authority(const std::string& host, std::uint16_t port);

/// One that is free now. 0: there is none, or no such host.
std::uint16_t free_port(const std::string& host);

/// Whether a program listens there.
bool is_listening(const std::string& host, std::uint16_t port);

}  // namespace ziggurat::gallery
