#pragma once
// Wall time of recent ticks by phase.

#include <array>
#include <vector>

#include "network/latencies.h"
#include "wire/request.h"

namespace ziggurat::supervision {

/// Parts of a tick's wall time.
enum class Phase { exchange, physics, recording, pacing };
constexpr std::size_t phase_count = 4;

class TickBudget {
 public:
  /// Adds the wall time of a phase of one tick.
  void add(Phase phase, double seconds);

  /// Appends each phase that has any time to the status.
  void fill(wire::Status& status) const;

 private:
  std::array<network::Latencies, phase_count> times_;  // by Phase
};

}  // namespace ziggurat::supervision
