#pragma once
// robot.positioning: position, orientation

#include <lua.hpp>

#include "script/scripted_robot.h"

namespace ziggurat::lua {

// As DeviceKind says.
bool has_positioning(const ScriptedRobot& robot);
void push_positioning(lua_State* state, ScriptedRobot& robot);
void refresh_positioning(lua_State* state, const ScriptedRobot& robot);

}  // namespace ziggurat::lua
