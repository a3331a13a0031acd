#pragma once
// robot.proximity[i]: a number, or {value, angle} if the sensors tell their angles

#include <lua.hpp>

#include "script/scripted_robot.h"

namespace ziggurat::lua {

// As DeviceKind says.
bool has_proximity(const ScriptedRobot& robot);
void push_proximity(lua_State* state, ScriptedRobot& robot);
void refresh_proximity(lua_State* state, const ScriptedRobot& robot);

}  // namespace ziggurat::lua
