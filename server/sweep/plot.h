// SPDX-License-Identifier: MIT
#pragma once
// Means with error bars as a picture.

#include <optional>
#include <span>
#include <string>

#include "sweep/experiment.h"
#include "sweep/result.h"

namespace ziggurat::sweep {

struct Plot {
  std::size_t x = 0;                  ///< the axis from left to right: into Experiment::axes
  std::optional<std::size_t> series;  ///< a curve for each value of this axis
  std::string measure;                ///< from bottom to top
  double confidence = 0.95;           ///< of the error bars, in (0, 1)
};

/// The picture, in SVG. Intervals of a single value are none.
/// @throws text::UsageError if no run that finished has the measure
std::string to_svg(const Experiment& experiment, std::span<const Result> results, const Plot& plot);

}  // namespace ziggurat::sweep
