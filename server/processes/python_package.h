// SPDX-License-Identifier: MIT
#pragma once
// The Python client that belongs to this program, for the Python programs that it starts.

#include <string>

namespace ziggurat::processes {

/// A value of PYTHONPATH with which programs find the Python client beside this program, in a build
/// or an installation, before any other: a folder that has it alone, then what this program's own
/// PYTHONPATH has.
/// @param folder  of this program's own, in which the former is made
/// @returns       empty if there is no such package, or the folder takes nothing
std::string python_path(const std::string& folder);

}  // namespace ziggurat::processes
