// SPDX-License-Identifier: MIT
#pragma once
// Checks of a Hello: the grant of robots, or the refusal with its reason.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "network/barrier/barrier.h"
#include "network/keys.h"
#include "wire/messages.h"

namespace ziggurat::network {

wire::Refusal make_refusal(wire::ErrorCode code, std::string field, std::string message);

/// Asks the session's connection itself: without one it is lost from then on.
bool is_reachable(Barrier& barrier, Session& session);

// Why the Hello is refused, if it is; in the order of rule H15.

/// Because of its version or role, or for lack of room.
std::optional<wire::Refusal> check_hello(const Barrier& barrier, const wire::Hello& hello,
                                         const Roles& roles);
/// Because all places of this role are taken.
std::optional<wire::Refusal> check_places(const Barrier& barrier, wire::Role role);
/// Because its key may take nothing over, and it asks for that.
std::optional<wire::Refusal> check_takeover(const Barrier& barrier, const wire::Hello& hello,
                                            const Access& access);
/// Because its policy is STOP, or waits longer than the controller's own policy. A key that may
/// neither end nor stop the run is refused both (K11).
/// @param robots  robots that the policy is for
std::optional<wire::Refusal> check_power(const Barrier& barrier, const wire::Hello& hello,
                                         const Access& access, std::span<const std::size_t> robots);
/// Because of the deadline policy that it asks for.
/// @param robots  that it is to hold for
std::optional<wire::Refusal> check_policy(const Barrier& barrier, const wire::Hello& hello,
                                          std::span<const std::size_t> robots);
/// The robots of a new session: all that the Hello asks for and that its key may have. Connections
/// of their sessions are probed, and those that are gone are lost from then on.
std::variant<std::vector<std::size_t>, wire::Refusal> grant_robots(Barrier& barrier,
                                                                   const wire::Hello& hello,
                                                                   const Access& access);

}  // namespace ziggurat::network
