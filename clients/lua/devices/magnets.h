#pragma once
// robot.magnets.<id>: set_current(current)

#include <lua.hpp>

#include "script/scripted_robot.h"

namespace ziggurat::lua {

// As DeviceKind says; nothing is sensed.
bool has_magnets(const ScriptedRobot& robot);
void push_magnets(lua_State* state, ScriptedRobot& robot);

}  // namespace ziggurat::lua
