// SPDX-License-Identifier: MIT
#pragma once
// End of sessions, and departure of robots (docs/protocol.md, section 5).

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "network/barrier/barrier.h"
#include "wire/messages.h"

namespace ziggurat::network {

/// Handles the Leave in `barrier.inbox`.
void handle_leave(Barrier& barrier, Session& session);

/// The session's connection is gone, or closed: its robots are free, and it may resume.
void lose(Barrier& barrier, Session& session, std::string_view why);
/// The connection is gone, and its session is lost.
void disconnect(Barrier& barrier, const std::string& connection);
/// Another client takes over robots: the sessions that have them, or may resume with them, go on
/// with the rest. Those without any robot left are over.
/// @param robots  into Layout::robots, ascending; free afterwards
/// @param by  the other client
void take_over(Barrier& barrier, std::span<const std::size_t> robots, const std::string& by);
/// Tells a connected session which of its robots were taken over so far: also a new process that
/// resumes it knows then. False if the session is lost now.
bool tell_taken(Barrier& barrier, Session& session, const std::string& by);
/// The session is over, and forgotten.
void erase(Barrier& barrier, Session& session);

/// Tells the session that it gets no more ticks: it is DRAINING. False if it can't be told.
bool end(Barrier& barrier, Session& session, std::string why);
/// The run is over: every session is told.
void finish(Barrier& barrier, const wire::End& end);
/// There is no world: those whose Hello waits for it are refused.
void refuse_waiting(Barrier& barrier);

/// Takes a robot out of the barrier for good.
void remove_robot(Barrier& barrier, std::size_t robot);

}  // namespace ziggurat::network
