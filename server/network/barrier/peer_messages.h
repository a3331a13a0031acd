// SPDX-License-Identifier: MIT
#pragma once
// Messages to one peer in its encoding, and answers to bad messages.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "network/barrier/barrier.h"

namespace ziggurat::network {

// Each sends the message in `barrier.outbox`, in the form that the peer talks.
Delivery send(Barrier& barrier, const std::string& connection);
Delivery send(Barrier& barrier, Session& session);

/// Why a session is lost that its tick reached so; empty: it is not.
std::string_view lost_by(Delivery delivery, const Session& session);

/// Tells people what a client did, unless there was too much of that a moment ago.
/// @param session  null: it has none
void note(Barrier& barrier, const Session* session, std::string_view sentence);
/// Answers a bad message. A session that sends nothing else is closed.
/// @param session  of the connection; null: none
/// @param request  the number of the request that the message was, if it was one
void answer_fault(Barrier& barrier, const std::string& connection, Session* session,
                  wire::Fault fault, std::optional<std::uint64_t> request = {});
/// Tells a peer why its connection ends.
void tell_fatal(Barrier& barrier, const std::string& connection, wire::Fault fault);
/// @param why  what makes the message none of the protocol
void answer_malformed(Barrier& barrier, const std::string& connection, Session* session,
                      std::string_view why);

/// Standing of a connection with this session; null: it has none.
Standing standing_of(const Session* session);
/// Longest message that the client may send [bytes].
std::size_t longest_message(const Barrier& barrier, const Session* session);

/// The current tick; 0 before the first.
std::uint64_t tick_of(const Barrier& barrier);
/// The epoch, if the session knows of epochs.
std::optional<std::uint64_t> epoch_for(const Barrier& barrier, const Session& session);
/// Some of these robots, for messages: "r0, r1, r2 and 7 more".
/// @param robots  into Layout::robots
std::string names_of(const Barrier& barrier, std::span<const std::size_t> robots);
/// The same of a session's robots.
std::string robots_of(const Barrier& barrier, const Session& session);

}  // namespace ziggurat::network
