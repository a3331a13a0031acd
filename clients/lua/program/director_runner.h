// SPDX-License-Identifier: MIT
#pragma once
// Runs the script of a director from its first tick to its end.

#include "program/options.h"
#include "ziggurat/director.h"

namespace ziggurat::lua {

/// Until the run is over or a signal interrupts it. Leaves the run.
/// @param director  freshly opened
/// @returns whether the script did not fail
/// @throws ConnectionError, ProtocolError; std::runtime_error if a folder of the options is none
bool run_director(Director& director, const ProgramOptions& options);

}  // namespace ziggurat::lua
