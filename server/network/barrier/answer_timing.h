// SPDX-License-Identifier: MIT
#pragma once
// Response times of controllers, for the status and for report cards.

#include <cstddef>
#include <cstdint>

#include "network/barrier/barrier.h"

namespace ziggurat::network {

/// The session's Command for the current tick was taken.
void measure_answer(Barrier& barrier, Session& session);
/// The session has missed the current tick: its Command may still come.
void expect_late_answer(Barrier& barrier, Session& session);
/// The session's Command for a tick that it has missed has come.
void measure_late_answer(Barrier& barrier, Session& session, std::uint64_t tick);
/// No Command comes any more for ticks that the session has missed.
void give_up_answers(Barrier& barrier, Session& session);
/// A robot without session has missed the current tick.
/// @param since  when it became free
void measure_absence(Barrier& barrier, std::size_t robot, Time since);

}  // namespace ziggurat::network
