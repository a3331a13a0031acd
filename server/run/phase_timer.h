#pragma once
// Measures where the wall time of a run goes.

#include <array>
#include <chrono>

#include "reports/summary.h"
#include "supervision/supervision.h"
#include "supervision/tick_budget.h"

namespace ziggurat::run {

class PhaseTimer {
 public:
  /// Adds the time since the last call to the start-up of the run.
  void end_startup(reports::Summary& summary) { summary.startup_s += restart(); }

  /// Adds the time since the last call to a phase of the tick and of the run.
  void end_phase(supervision::Phase phase, reports::Summary& summary);

  /// Passes the phases of the tick on.
  /// @param is_paced  otherwise a tick has no pacing
  void end_tick(supervision::Supervision& supervision, bool is_paced);

  /// Time of each Phase in the last tick that ended [s].
  const std::array<double, supervision::phase_count>& last_tick() const { return last_tick_; }

 private:
  using clock = std::chrono::steady_clock;
  double restart();  ///< [s] since the last call

  clock::time_point last_ = clock::now();
  std::array<double, supervision::phase_count> tick_{}, last_tick_{};  ///< by Phase [s]
};

}  // namespace ziggurat::run
