#pragma once
// robot.wheels: set_velocity(left, right), velocity_left, … axis_length

#include <lua.hpp>

#include "script/scripted_robot.h"

namespace ziggurat::lua {

// As DeviceKind says.
bool has_wheels(const ScriptedRobot& robot);
void push_wheels(lua_State* state, ScriptedRobot& robot);
void refresh_wheels(lua_State* state, const ScriptedRobot& robot);

}  // namespace ziggurat::lua
