// SPDX-License-Identifier: MIT
#pragma once
// Runs robots that come while the program runs: each in a session of its own, all in this process,
// one script at a time.

#include <functional>
#include <string>

#include "program/options.h"

namespace ziggurat::lua {

/// Runs one robot in a session of its own, to its end. @returns an exit code
using RunRobot = std::function<int(const ProgramOptions& options)>;

/// Runs each robot whose id arrives, until there are no more and all have ended, or a signal
/// arrives.
/// @param options  of each, apart from the robot; robots_from is the pipe that ids are read from,
/// one a line
/// @returns the largest exit code
/// @throws std::runtime_error if the pipe can't be read
int run_arriving_robots(const ProgramOptions& options, const RunRobot& run);

}  // namespace ziggurat::lua
