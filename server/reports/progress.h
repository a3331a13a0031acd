#pragma once
// The progress line: simulated time, real-time factor, ticks per second, awaited robots.

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include "reports/console.h"

namespace ziggurat::reports {

class Progress {
 public:
  /// @param tick_length  simulated [s]
  Progress(Console& console, double tick_length) : console_(console), tick_length_(tick_length) {}

  /// Whether stderr is a terminal and the last line is old enough.
  bool needs_update() const;

  /// Rates are measured since the previous line.
  void show(std::uint64_t tick, std::string_view waiting_for);

 private:
  using clock = std::chrono::steady_clock;

  Console& console_;
  double tick_length_;
  clock::time_point shown_at_ = clock::now();
  std::uint64_t shown_tick_ = 0;
};

}  // namespace ziggurat::reports
