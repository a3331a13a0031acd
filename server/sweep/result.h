// SPDX-License-Identifier: MIT
#pragma once
// Result of a run that has ended: a row of the table.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>

namespace ziggurat::sweep {

enum class Outcome {
  finished,
  failed,     ///< it ended with another exit code than 0, or without a summary
  timed_out,  ///< it took more wall time than `--timeout` allows
};
const char* to_text(Outcome outcome);
/// Nothing for another text.
std::optional<Outcome> to_outcome(const std::string& text);

struct Result {
  std::size_t run = 0;  ///< from 1 on
  std::uint64_t seed = 0;
  Outcome outcome = Outcome::finished;
  int exit_code = 0;  ///< 128 + N: signal N killed it

  // Fields of its summary; without one these are empty.
  std::string ending;  ///< `finished`, `shut_down`, … as in the summary
  std::optional<std::uint64_t> ticks;
  std::optional<double> simulated_s;
  std::string hash;  ///< of the final state: 16 hexadecimal digits
  std::optional<std::uint64_t> robots, failures, dropped;
  std::optional<std::uint64_t> not_converged;  ///< islands of contacts that the solver gave up
  std::optional<double> worst_residual;        ///< of the solver [m/s or rad/s]
  std::map<std::string, double> metrics;       ///< final values

  double wall_s = 0;    ///< from start to end of the process
  std::string version;  ///< of Ziggurat
};

/// The metrics that a run has.
std::set<std::string> metric_names(std::span<const Result> results);

/// Reads the file of `ziggurat run --summary` into the result.
/// @returns whether it is there and whole
bool read_summary(const std::string& path, Result& result);

}  // namespace ziggurat::sweep
