// SPDX-License-Identifier: MIT
#pragma once
// Figures of a run that its controllers measure.

#include <string>

namespace ziggurat::world {

struct Metric {
  std::string robot;  ///< id
  std::string name;   ///< 1 to 64 letters, digits, `_`, `-`, `.`
  double value = 0;   ///< finite
};

/// `ROBOT/NAME`: under that a metric stands in outputs for programs.
inline std::string key_of(const Metric& metric) { return metric.robot + "/" + metric.name; }

}  // namespace ziggurat::world
