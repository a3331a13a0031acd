// SPDX-License-Identifier: MIT
#pragma once
// Place file for a program that watches this one: the robot whose script runs, its file, and the
// line of a long call. It is mapped into memory. So a signal handler can write it, and each call
// costs no more than a copy of the id.

#include <string>

namespace ziggurat::lua {

/// From now on the file has `ROBOT`, a line feed, `FILE:LINE` or `FILE`, and a 0 byte; no robot
/// while no script runs.
/// @throws std::runtime_error if it can't be written
void open_place_file(const std::string& path);

/// May be called from a signal handler; without effect if there is no file.
/// @param robot  its id; empty: no script runs
/// @param place  `FILE:LINE`, or `FILE`
void write_place(const char* robot, const char* place) noexcept;

}  // namespace ziggurat::lua
