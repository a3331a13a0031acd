// SPDX-License-Identifier: MIT
#pragma once
// The summary of a run, as text and as JSON.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "timing/phases.h"
#include "wire/request.h"

namespace ziggurat::reports {

/// Ending of the program.
namespace exit_code {
constexpr int finished = 0;
constexpr int fault = 1;  ///< of scene, arguments or environment
constexpr int controller_failed = 3;
constexpr int gate_missed = 4;    ///< a controller did not keep up as --gate asks
constexpr int differs = 5;        ///< a recording from its repetition, or from another one
constexpr int damaged = 6;        ///< a recording; what can be read of it is the same
constexpr int interrupted = 130;  ///< Ctrl-C
}  // namespace exit_code

/// Why a run ended.
enum class Ending {
  finished,
  interrupted,
  shut_down,  ///< as a supervisor planned, with a reason
  forced,
  controller_vanished,
  failed_fast,      ///< at the first failure, as --fail-fast asks
  deadline_missed,  ///< of a controller whose policy is to stop
  reset,            ///< of the world; the run continues
};

struct Summary {
  std::string scene;  ///< path as given
  Ending ending = Ending::finished;
  std::uint64_t ticks = 0;
  double simulated_s = 0;
  timing::PhaseTimes wall;       ///< wall time of the start-up and of the ticks
  std::uint64_t late_ticks = 0;  ///< paced ticks that began after their time
  std::uint64_t seed = 0;
  std::uint64_t hash = 0;
  std::size_t robots = 0;
  wire::SolverStatus solver;

  struct Failure {
    std::string robot;
    std::string controller;
    std::uint64_t tick = 0;
    std::string message;
    std::string director = {};  ///< that failed; empty: a robot's controller did
  };
  std::vector<Failure> failures;  ///< in order of time
  struct Departure {
    std::string robot;
    std::string controller;
    std::uint64_t tick = 0;  ///< the last that it took part in
  };
  std::vector<Departure>
      departures;               ///< robots whose controller left before the end; in order of time
  std::string shutdown_reason;  ///< shut_down: why
  /// Result with which a director has ended the run.
  struct Result {
    std::string director;  ///< id
    std::string text;
  };
  std::optional<Result> result;
  std::vector<std::string> dropped;  ///< a sentence on each robot that a deadline took out
  bool drops_are_failures = true;
  std::string
      recording_failure;  ///< why the recording is not complete, and what it lacks; empty: it is
  std::string vanished;   ///< the sentence on the controller that ended the run; empty: none did

  struct Missed {
    std::string controller;
    std::uint64_t ticks = 0;  ///< at which at least one of its robots missed a deadline
  };
  std::vector<Missed> missed;  ///< controllers that missed any, in scene order
  /// Last values, by `ROBOT/NAME`.
  std::map<std::string, double> metrics;
};

/// Several lines without line feed at the end, without the failures.
std::string to_text(const Summary& summary);
std::string to_json(const Summary& summary);  ///< one line

int exit_code_of(const Summary& summary);

}  // namespace ziggurat::reports
