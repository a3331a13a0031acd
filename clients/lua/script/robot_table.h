// SPDX-License-Identifier: MIT
#pragma once
// The table of a robot: its id, params and devices.

#include <lua.hpp>

#include "ziggurat/robot.h"

namespace ziggurat::lua {

/// Pushes it. The robot outlives the state and does not move; a state may have several robots. May
/// raise a Lua error.
void push_robot(lua_State* state, Robot& robot);

/// Writes the readings of the robot into its tables. May raise a Lua error.
void refresh_robot(lua_State* state, Robot& robot);

}  // namespace ziggurat::lua
