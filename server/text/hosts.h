// SPDX-License-Identifier: MIT
#pragma once
// Hosts where a server listens, as programs and people of this machine call them.

#include <string>
#include <string_view>

namespace ziggurat::text {

/// Whether it means all addresses of this machine: `0.0.0.0`, `*`, `::`. None of them can be
/// called from a browser or a client.
bool is_every_host(std::string_view host);

/// Host to call: 127.0.0.1 or ::1 if the server listens at all addresses, otherwise the host
/// itself.
std::string host_to_call(std::string_view host);

/// The same of an endpoint `tcp://HOST:PORT`; others stay as they are.
std::string endpoint_to_call(std::string_view endpoint);

/// Note for people, if a server listens at all addresses; otherwise empty.
std::string note_of_every_host(std::string_view host);

/// HOST of `tcp://HOST:PORT`, without brackets; empty: it is another endpoint.
std::string_view host_of_endpoint(std::string_view endpoint);

}  // namespace ziggurat::text
