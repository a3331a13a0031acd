// SPDX-License-Identifier: MIT
#pragma once
// When ticks end on the wall clock.

#include <chrono>
#include <cstdint>
#include <optional>

namespace ziggurat::run {

/// Absolute: a late tick does not delay those after it, a pause does.
class Schedule {
 public:
  using clock = std::chrono::steady_clock;

  /// @param factor  simulated seconds per second of wall time; nothing: without pacing
  /// @param tick_length  [s] simulated
  Schedule(std::optional<double> factor, double tick_length)
      : factor_(factor), tick_length_(tick_length) {}

  /// From now on, with this tick.
  /// @param paused  how long the world has been paused until now
  void begin(std::uint64_t tick, clock::duration paused) {
    tick_ = tick;
    start_ = clock::now() - paused;
  }
  void set_factor(std::optional<double> factor, std::uint64_t tick, clock::duration paused) {
    factor_ = factor;
    begin(tick, paused);
  }

  bool is_paced() const { return factor_.has_value(); }
  std::optional<double> factor() const { return factor_; }

  /// When the tick after this one is to begin; long ago without pacing.
  clock::time_point end_of(std::uint64_t tick, clock::duration paused) const {
    if (!factor_) return {};
    const double simulated_s =
        (static_cast<double>(tick) + 1 - static_cast<double>(tick_)) * tick_length_;
    return start_ + paused +
           std::chrono::duration_cast<clock::duration>(
               std::chrono::duration<double>(simulated_s / *factor_));
  }

 private:
  std::optional<double> factor_;
  double tick_length_;
  std::uint64_t tick_ = 0;     // that began at `start_`
  clock::time_point start_{};  // without pauses
};

}  // namespace ziggurat::run
