// SPDX-License-Identifier: MIT
#pragma once
// Devices that describe themselves, below `robot`: robot.<kind> unless shapes.h says otherwise. It
// has a device at each position, or at each id if they have ids:
//  - a number if the device has one reading, no property and no command,
//  - otherwise a table of readings, properties and functions set_<command>(value),
//  - an array of its rows, each a table of readings, if it reads rows; functions stand beside them.
// A single device that reads rows or only takes commands, and has no id, is robot.<kind> itself.

#include <lua.hpp>

#include "ziggurat/robot.h"

namespace ziggurat::lua {

/// Sets the fields of the robot's table on top, and pushes what fill_described() gets. The robot
/// outlives the state and does not move.
void make_described(lua_State* state, Robot& robot);

/// Writes the readings into the value on top.
void fill_described(lua_State* state, Robot& robot);

}  // namespace ziggurat::lua
