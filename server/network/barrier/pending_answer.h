// SPDX-License-Identifier: MIT
#pragma once
// The answer that a session owes to the current tick.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "network/link.h"

namespace ziggurat::network {

/// A tick waits at most this many deadlines of a robot, however often the robot changes its session
/// (W11).
inline constexpr int most_deadlines_a_tick = 3;

/// Time that a tick still waits for a robot that changes its session.
/// @param before  time that it has waited already
inline std::chrono::nanoseconds time_left(std::chrono::nanoseconds deadline,
                                          std::chrono::nanoseconds before) {
  return std::clamp(most_deadlines_a_tick * deadline - before, std::chrono::nanoseconds{0},
                    deadline);
}

struct PendingAnswer {
  std::uint64_t tick = 0;       ///< of the session's last observation
  std::uint64_t epoch = 0;      ///< of the same observation
  bool is_owed = false;         ///< the observation is not answered yet
  bool has_missed = false;      ///< the tick goes on without the answer
  bool is_resent = false;       ///< the observation was sent before, to this session or another
  unsigned late_commands = 0;   ///< commands for missed ticks that may still arrive
  unsigned stale_commands = 0;  ///< the same for ticks before a reset or restore of the world
  Time waiting_since;           ///< begin of the deadline: the observation was sent
  std::chrono::nanoseconds waited{0};  ///< until the answer came or was missed
  std::chrono::nanoseconds waited_before{
      0};  ///< by the same tick, for earlier sessions of these robots
  struct Missed {
    std::uint64_t tick = 0;
    Time sent;  ///< its observation
  };
  std::vector<Missed>
      missed;  ///< missed ticks without command so far, ascending, if reactions are kept
  std::optional<std::chrono::milliseconds> deadline;  ///< none: the tick waits without end

  /// Time until which the tick waits for the answer. @param limit  the deadline, if there is one
  Time due_at(std::chrono::milliseconds limit) const {
    return waiting_since + time_left(limit, waited_before);
  }
};

}  // namespace ziggurat::network
