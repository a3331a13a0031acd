// SPDX-License-Identifier: MIT
#pragma once
// The progress line: simulated time, its share of the run and the wall time that is left,
// real-time factor, ticks per second, awaited robots.

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "reports/console.h"

namespace ziggurat::reports {

class Progress {
 public:
  /// @param tick_length  simulated [s]
  /// @param ticks  of the whole run; none: it has no end of its own
  Progress(Console& console, double tick_length, std::optional<std::uint64_t> ticks = {})
      : console_(console), tick_length_(tick_length), ticks_(ticks) {}

  /// Whether stderr is a terminal and the last line is old enough.
  bool needs_update() const;

  /// Rates are measured since the previous line.
  void show(std::uint64_t tick, std::string_view waiting_for);

 private:
  using clock = std::chrono::steady_clock;

  Console& console_;
  double tick_length_;
  std::optional<std::uint64_t> ticks_;
  double usual_rate_ = 0;  ///< [ticks/s], over some seconds
  clock::time_point shown_at_ = clock::now();
  std::uint64_t shown_tick_ = 0;
};

/// The beginning of the line: `t = 1.00 of 10.00 s (10 %), 9 s left`.
/// @param tick_length  simulated [s]
/// @param rate  [ticks/s of wall time]; 0: how much is left is not known
std::string reached(std::uint64_t tick, std::optional<std::uint64_t> ticks, double tick_length,
                    double rate);

struct Speed {
  std::uint64_t tick;
  std::optional<std::uint64_t> ticks;  ///< of the whole run
  double tick_length;                  ///< simulated [s]
  double rate, usual_rate;             ///< since the last line, and over some seconds [ticks/s]
};

/// The whole line. A terminal cuts it at its width: whom the world waits for stands before what is
/// not true meanwhile.
std::string progress_line(const Speed& at, std::string_view waiting_for);

}  // namespace ziggurat::reports
