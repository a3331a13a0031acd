// SPDX-License-Identifier: MIT
#pragma once
// The tick path: observations out, commands in, and pauses between ticks (docs/protocol.md,
// section 3).

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "network/barrier/barrier.h"
#include "world/commands.h"
#include "world/devices.h"

namespace ziggurat::network {

/// A tick begins: every session that has robots is sent what they sense. Both stay as they are
/// until the next tick, or reset().
/// @param tag_payloads  for each of Layout::tags
/// @param truth  that directors are told, likewise; null: none
void publish(Barrier& barrier, const world::Observations& observations,
             const std::vector<std::string>& tag_payloads, const wire::Truth* truth = nullptr);
/// Observations of the current tick leave the server only now: the deadlines of their answers
/// begin.
void await_from(Barrier& barrier, Time now);
/// Sends a session what its robots sense at the current tick. @returns why it is lost; empty: it is
/// not
std::string_view observe(Barrier& barrier, Session& session);

/// Handles the Command in `barrier.inbox`. True if it is the expected answer.
/// @param commands  where its values go; null: no tick is being collected
bool handle_command(Barrier& barrier, Session& session, world::Commands* commands);

/// Why the metrics of the Command or Leave in `barrier.inbox` can't be taken, if they can't.
std::optional<wire::Fault> check_metrics(const Barrier& barrier, const Session& session);
/// Takes these metrics, which were checked.
void take_metrics(Barrier& barrier, const Session& session);

/// The tick is complete: zeroes the targets of robots that have left, or whose deadline policy says
/// so.
void zero_missing(Barrier& barrier, world::Commands& commands);

/// No tick is complete from now on. Once the current one is answered, sessions are told.
void pause(Barrier& barrier);
/// If the world is paused and its tick answered, those who have answered are told so.
void halt_if_paused(Barrier& barrier);
/// The world is not paused any more. Deadlines begin anew.
void resume(Barrier& barrier);

}  // namespace ziggurat::network
