// SPDX-License-Identifier: MIT
#pragma once
// A stopwatch for phases: each stage says which phase begins, and the time goes to it until another
// begins. So the phases add up to the whole. No result of a simulation may depend on it.

#include <chrono>

#include "timing/phases.h"

namespace ziggurat::timing {

/// Counts of the processor's clock, which takes a third of the time of the system's to read.
inline std::uint64_t clock_counts() {
#if defined(__x86_64__) || defined(__i386__)
  return __builtin_ia32_rdtsc();
#else
  return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
#endif
}

class Stopwatch {
 public:
  explicit Stopwatch(Phase phase = Phase::startup) { start(phase); }

  /// The time from now on goes to a phase; that before goes to none.
  void start(Phase phase) {
    phase_ = phase;
    last_ = clock_counts();
  }
  /// The time from now on goes to a phase; that before went to the phase that was entered last.
  void enter(Phase phase) {
    if (phase == phase_) return;
    stop();
    phase_ = phase;
  }
  /// Ends the time of the present phase, which begins again.
  void stop() {
    const std::uint64_t now = clock_counts();
    counts_[static_cast<std::size_t>(phase_)] += now - last_;
    last_ = now;
  }

  /// Divides the time since the last change among phases as another watch has measured them: the
  /// time of a stage that threads have shared, by the sum of their watches.
  void divide_like(const Stopwatch& other);
  void add(Stopwatch& other);  ///< what it has measured, which is cleared

  /// Time of each phase since the last call [s]. The present phase goes on.
  PhaseTimes take();

 private:
  std::array<std::uint64_t, phase_count> counts_{};  // by Phase
  Phase phase_ = Phase::startup;
  std::uint64_t last_ = 0;
  // Begin of what counts_ measure, by both clocks.
  std::uint64_t first_ = clock_counts();
  std::chrono::steady_clock::time_point since_ = std::chrono::steady_clock::now();
};

/// Enters a phase, if something is measured.
inline void enter(Stopwatch* watch, Phase phase) {
  if (watch) watch->enter(phase);
}

}  // namespace ziggurat::timing
