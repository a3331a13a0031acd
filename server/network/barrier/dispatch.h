// SPDX-License-Identifier: MIT
#pragma once
// One message of a peer, from its bytes to the rule that handles it (docs/protocol.md, section 4).

#include "network/barrier/barrier.h"
#include "network/link.h"
#include "world/commands.h"

namespace ziggurat::network {

/// Handles a message that arrives at `barrier.now`.
/// @param commands  where values go while a tick is being collected; null otherwise
void receive(Barrier& barrier, const Received& received, world::Commands* commands);

/// Whether the session that called is still there.
bool can_hear(const Barrier& barrier, const Call& call);
/// Answers a call; `write` puts the response into the outbox.
void answer(Barrier& barrier, const Call& call, const std::function<void(wire::Outbox&)>& write);

}  // namespace ziggurat::network
