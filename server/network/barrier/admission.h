// SPDX-License-Identifier: MIT
#pragma once
// Begin of sessions (docs/protocol.md, section 2).

#include <string>

#include "network/barrier/barrier.h"
#include "network/keys.h"
#include "world/commands.h"

namespace ziggurat::network {

/// Handles the Hello in `barrier.inbox`, of a connection without a session: Welcome or Refusal.
/// While the world is loading it waits.
/// @param access  of the connection
/// @param bytes  the whole message
/// @param commands  of the tick that is being collected; null: no tick is
void handle_hello(Barrier& barrier, const std::string& connection, const Access& access,
                  std::string_view bytes, const world::Commands* commands);

/// The world is loaded: handles those that wait as if they had just arrived, in the order of
/// arrival.
void admit_waiting(Barrier& barrier);

}  // namespace ziggurat::network
