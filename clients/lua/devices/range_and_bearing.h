#pragma once
// robot.range_and_bearing: [i], set_data(…), clear_data()

#include <lua.hpp>

#include "script/scripted_robot.h"

namespace ziggurat::lua {

// As DeviceKind says.
bool has_range_and_bearing(const ScriptedRobot& robot);
void push_range_and_bearing(lua_State* state, ScriptedRobot& robot);
void refresh_range_and_bearing(lua_State* state, const ScriptedRobot& robot);

}  // namespace ziggurat::lua
