// SPDX-License-Identifier: MIT
#pragma once
// Endpoints that a client connects to.

#include <string>

namespace ziggurat {

/// Checks that a server can listen at it.
/// @throws std::invalid_argument that says what an endpoint is
void check_endpoint(const std::string& endpoint);

/// Whether the host of an endpoint has a name without address. Asks the system, which may take its
/// time.
bool has_unknown_host(const std::string& endpoint);

}  // namespace ziggurat
