// SPDX-License-Identifier: MIT
#pragma once
// The columns of a table of results, and the table as CSV.

#include <array>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "sweep/experiment.h"
#include "sweep/result.h"

namespace ziggurat::sweep {

// A row has the run's number, the axes, these, the metrics, and the last ones.
inline constexpr std::array result_columns = {"seed",
                                              "outcome",
                                              "exit_code",
                                              "ending",
                                              "ticks",
                                              "simulated_s",
                                              "robots",
                                              "failures",
                                              "dropped",
                                              "solver_not_converged",
                                              "solver_worst_residual",
                                              "hash"};
inline constexpr std::array last_columns = {"wall_s", "version"};

/// Names of columns, each once, as SQLite compares them: without regard to the case of A to Z. An
/// axis that is called as another column gets `param_` before its name, a metric `metric_`.
struct Columns {
  std::vector<std::string> axes;               ///< parallel to Experiment::axes
  std::map<std::string, std::string> metrics;  ///< by metric
};
Columns columns_of(const Experiment& experiment, std::span<const Result> results);

/// A line of names and a line per run (RFC 4180, but with line feeds only). Numbers have the
/// shortest digits that give the same number again; what is not known is empty.
std::string to_csv(const Experiment& experiment, std::span<const Result> results);

}  // namespace ziggurat::sweep
