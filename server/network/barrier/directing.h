// SPDX-License-Identifier: MIT
#pragma once
// The rules for directors (docs/protocol.md, section 9.1), where they differ from those for
// controllers.

#include <string_view>
#include <variant>

#include "network/barrier/barrier.h"
#include "network/report.h"

namespace ziggurat::network {

/// The world is loaded: its directors are awaited.
/// @param deadlines  behind those of controllers theirs, if they are not as the scene says
void add_directors(Barrier& barrier, const std::vector<Config::Deadline>& deadlines);

/// A new session of the director that the Hello asks for.
std::variant<Session*, wire::Refusal> begin_directing(Barrier& barrier, const wire::Hello& hello,
                                                      const std::string& client);
/// Refuses a Hello whose subscription is wrong.
std::optional<wire::Refusal> check_subscription(const wire::Hello& hello);
/// Refuses a Hello that asks for a policy where the server fixes another for its director.
std::optional<wire::Refusal> check_fixed(const Barrier& barrier, std::size_t director,
                                         const wire::Hello& hello);
/// It has its director from now on.
void take_director(Barrier& barrier, Session& session, const wire::Hello& hello);
/// It has none any more; the director is free. No effect without one.
void release_director(Barrier& barrier, Session& session, Claim claim);
/// The director leaves the barrier for good, and its session goes on without it.
void remove_director(Barrier& barrier, Session& session);

/// Sends what the director is told of the current tick. @returns why its session is lost; empty: it
/// is not
std::string_view show_world(Barrier& barrier, Session& session);
/// Handles the Direction in `barrier.inbox`. True if it is the expected answer.
bool handle_direction(Barrier& barrier, Session& session, bool is_collecting);
/// The same for the Leave of a director.
void leave_directing(Barrier& barrier, Session& session);

/// The world begins anew or has gone back.
void forget_directions(Barrier& barrier);

/// Directions to apply before the next tick, in the order of their directors' ids. Valid until the
/// next message.
const std::vector<Directed>& directions(Barrier& barrier);
bool wants_contacts(const Barrier& barrier);  ///< one subscribed to them
/// Tells a director that is connected of an act that was not done.
void warn_director(Barrier& barrier, const std::string& director, wire::Fault fault);
std::vector<DirectorStatus> director_status(const Barrier& barrier);

}  // namespace ziggurat::network
