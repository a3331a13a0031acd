#pragma once
// robot.battery: available_charge, time_left

#include <lua.hpp>

#include "script/scripted_robot.h"

namespace ziggurat::lua {

// As DeviceKind says.
bool has_battery(const ScriptedRobot& robot);
void push_battery(lua_State* state, ScriptedRobot& robot);
void refresh_battery(lua_State* state, const ScriptedRobot& robot);

}  // namespace ziggurat::lua
