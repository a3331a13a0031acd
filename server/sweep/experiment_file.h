// SPDX-License-Identifier: MIT
#pragma once
// An experiment as a TOML file: what the command line says, to keep and to share.

#include <optional>
#include <string>

#include "sweep/experiment.h"

namespace ziggurat::sweep {

struct ExperimentFile {
  Experiment experiment;  ///< without seeds, if the file has none
  // Settings of the runs; the command line may replace them.
  std::string out;                ///< path; empty: the file has none
  std::optional<unsigned> jobs;   ///< runs at a time
  std::optional<double> timeout;  ///< wall time of a run [s]
  std::string record;             ///< `failed` or `all`; empty: the file has none
};

/// Paths in the file begin at its folder.
/// @throws text::UsageError with all of `file:line:column: text`
ExperimentFile read_experiment(const std::string& path);

}  // namespace ziggurat::sweep
