// SPDX-License-Identifier: MIT
#pragma once
// Conditions for runs with hardware in the loop: "p99<2ms,misses<0.1%".

#include <string>
#include <vector>

namespace ziggurat::reports {

/// One condition on every controller.
struct Condition {
  enum class Subject { p50, p90, p99, p999, max, jitter, misses, run, late };
  Subject subject = Subject::p99;
  bool is_share = false;  ///< misses, run, late: of all ticks; otherwise their number
  double limit = 0;       ///< [s], a share, or a number; the measured value must be below
  std::string text;       ///< as written
};

/// Whether it is measured in seconds.
inline bool is_time(Condition::Subject subject) { return subject < Condition::Subject::misses; }

/// Whether it counts what a deadline makes a miss.
inline bool is_of_misses(Condition::Subject subject) {
  return subject == Condition::Subject::misses || subject == Condition::Subject::run;
}

/// @throws text::UsageError that names the wrong part
std::vector<Condition> parse_gate(const std::string& text);

}  // namespace ziggurat::reports
