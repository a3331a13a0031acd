#pragma once
// What one session owes at the tick in hand.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "network/link.h"

namespace ziggurat::network {

/// A tick waits so many deadlines of a robot at most, however often it changes hands (W11).
inline constexpr int most_deadlines_a_tick = 3;

/// How long a tick waits for a robot that changes hands.
/// @param before  for which it has waited already
inline std::chrono::nanoseconds time_left(std::chrono::nanoseconds deadline,
                                          std::chrono::nanoseconds before) {
  return std::clamp(most_deadlines_a_tick * deadline - before, std::chrono::nanoseconds{0}, deadline);
}

struct Turn {
  std::uint64_t tick = 0;      ///< of its last observation
  std::uint64_t epoch = 0;     ///< likewise
  bool owes = false;           ///< that observation is not answered yet
  bool has_missed = false;     ///< nor will it be: the tick goes on without the answer
  bool is_repeated = false;    ///< that observation was sent before, to it or another session
  unsigned late_commands = 0;  ///< for ticks that it missed, that may still arrive
  unsigned crossing = 0;       ///< likewise, for ticks of a world that was put back since
  Time owes_since;             ///< when that observation was sent
  std::chrono::nanoseconds waited{0};         ///< for the answer, which is there or was missed
  std::chrono::nanoseconds waited_before{0};  ///< by the same tick, for those who had its robots before
  struct Missed {
    std::uint64_t tick = 0;
    Time sent;  ///< its observation
  };
  std::vector<Missed> missed;  ///< such ticks, ascending, if reactions are kept
  /// Its deadline; none: the tick waits for it forever.
  std::optional<std::chrono::milliseconds> patience;

  /// Until when the tick waits for the answer. @param limit  patience, if it has one
  Time deadline(std::chrono::milliseconds limit) const {
    return owes_since + time_left(limit, waited_before);
  }
};

}  // namespace ziggurat::network
