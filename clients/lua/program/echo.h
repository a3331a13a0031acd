// SPDX-License-Identifier: MIT
#pragma once
// Log lines of scripts on the terminal.

#include <cstdint>
#include <string>

#include "script/log_lines.h"

namespace ziggurat::lua {

/// Prints the lines with their tick.
/// @param whose  id of the robot or director
void echo(const LogLines& log, std::uint64_t tick, const std::string& whose);

/// Says that lines were dropped.
void report_lost_log(std::uint64_t tick);

}  // namespace ziggurat::lua
