// SPDX-License-Identifier: MIT
#pragma once
// Means of runs that differ only in their seeds, with confidence intervals.

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "sweep/experiment.h"
#include "sweep/result.h"

namespace ziggurat::sweep {

struct Estimate {
  std::size_t count = 0;  ///< of the values
  double mean = std::numeric_limits<double>::quiet_NaN();
  /// Half of the confidence interval of the mean, by Student's t for unknown variance (Gosset
  /// 1908): t · s / √n. Not a number for fewer than two values.
  double half_width = std::numeric_limits<double>::quiet_NaN();
};
/// @param confidence  in (0, 1): 0.95
Estimate estimate(std::span<const double> values, double confidence);

/// Runs with the same values of some axes.
struct Group {
  std::vector<std::string> values;  ///< parallel to the axes that were asked for
  std::size_t finished = 0, failed = 0;
  std::vector<Estimate> estimates;  ///< of the runs that finished, parallel to the measures
};
/// @param axes      indices into Experiment::axes
/// @param measures  see value_of()
/// @returns in the order of their first runs
std::vector<Group> group(const Experiment& experiment, std::span<const Result> results,
                         std::span<const std::size_t> axes, std::span<const std::string> measures,
                         double confidence);

/// Names of columns that can be averaged: the metrics, ticks, simulated_s, wall_s, …; metrics
/// first, by name.
std::vector<std::string> measures_of(std::span<const Result> results);
/// A metric or another number of a run; not a number if the run has none.
double value_of(const Result& result, const std::string& measure);

/// The axis that a user names: by its whole name, or by what follows its `@`.
/// @throws text::UsageError with what there is
std::size_t axis_named(const Experiment& experiment, const std::string& name);

}  // namespace ziggurat::sweep
