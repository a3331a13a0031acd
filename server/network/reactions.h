// SPDX-License-Identifier: MIT
#pragma once
// Response time of a controller to each observation, kept one by one for report cards.

#include <cstdint>
#include <vector>

namespace ziggurat::network {

/// Response to one observation of a session.
struct Reaction {
  enum class Kind : std::uint8_t {
    in_time,     ///< a command
    late,        ///< a command, after the deadline: its values are lost
    unanswered,  ///< a miss, and no command for that tick ever
  };
  /// Wall time from the observation to its command. Unanswered: to the command for a later tick, or
  /// to the end of the session or the run; the deadline at least [s].
  double seconds = 0;
  std::uint32_t tick = 0;
  std::uint32_t world = 0;  ///< 0, and one more after each reset
  std::uint32_t robot = 0;  ///< into Layout::robots: the first of its controller in the session
  std::uint16_t controller = 0;  ///< of the scene
  Kind kind = Kind::in_time;
};
static_assert(sizeof(Reaction) == 24, "a run of a million ticks keeps a million for each session");

struct Reactions {
  bool are_kept = false;
  std::uint32_t world = 0;
  std::vector<Reaction> all;  ///< in the order in which they were known
};

}  // namespace ziggurat::network
