#pragma once
// What one session owes at the tick in hand.

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "network/link.h"

namespace ziggurat::network {

struct Turn {
  std::uint64_t tick = 0;      ///< of its last observation
  std::uint64_t epoch = 0;     ///< likewise
  bool owes = false;           ///< that observation is not answered yet
  bool has_missed = false;     ///< nor will it be: the tick goes on without the answer
  bool is_repeated = false;    ///< that observation was sent before, to it or another session
  unsigned late_commands = 0;  ///< for ticks that it missed, that may still arrive
  Time owes_since;             ///< when that observation was sent
  struct Missed {
    std::uint64_t tick = 0;
    Time sent;  ///< its observation
  };
  std::vector<Missed> missed;  ///< such ticks, ascending, if reactions are kept
  /// Its deadline; none: the tick waits for it forever.
  std::optional<std::chrono::milliseconds> patience;
};

}  // namespace ziggurat::network
