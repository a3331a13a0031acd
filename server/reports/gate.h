#pragma once
// Conditions for runs with hardware in the loop: "p99<2ms,misses<0.1%".

#include <string>
#include <vector>

namespace ziggurat::reports {

/// One condition on every controller.
struct Condition {
  enum class Subject { p50, p90, p99, p999, max, misses, late };
  Subject subject = Subject::p99;
  bool is_share = false;  ///< misses, late: of all ticks; otherwise their number
  double limit = 0;       ///< [s], a share, or a number; the measured value must be below
  std::string text;       ///< as written
};

/// @throws text::UsageError that names the wrong part
std::vector<Condition> parse_gate(const std::string& text);

/// What was measured of a controller.
struct Performance {
  double p50 = 0, p90 = 0, p99 = 0, p999 = 0, max = 0;  ///< from observation to command [s]
  double misses = 0;                                    ///< ticks
  double late = 0;  ///< ticks that began after their time, for any reason
  double ticks = 0;
};

/// The measured value, in the unit of the condition's limit.
double measured(const Condition& condition, const Performance& performance);

}  // namespace ziggurat::reports
