// SPDX-License-Identifier: MIT
#pragma once
// Timeouts: missed deadlines (docs/protocol.md, section 3.2), heartbeats, and progress messages
// while the world is loading.

#include <cstddef>

#include "network/barrier/barrier.h"

namespace ziggurat::network {

/// Wall time goes on: deadlines pass and heartbeats are sent.
void advance(Barrier& barrier, Time now);
/// Only heartbeats are sent: what robots there are may not be looked at now.
void keep_alive(Barrier& barrier, Time now);
/// When advance() has something to do next.
Time next_event(const Barrier& barrier);

/// Checks deadlines at the next advance().
void check_soon(Barrier& barrier);
/// A free robot is waited for from now on, until its deadline.
void expect_answer(Barrier& barrier, std::size_t robot);
/// The same for a session that has just been sent its observation.
void expect_answer(Barrier& barrier, const Session& session);
/// Robots or policies of the session have changed, and with them its deadline: the longest of its
/// robots, as it answers for all at once.
void update_deadline(Barrier& barrier, Session& session);

}  // namespace ziggurat::network
