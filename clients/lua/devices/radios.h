#pragma once
// robot.radios.<id>: tx_data(bytes), rx_data

#include <lua.hpp>

#include "script/scripted_robot.h"

namespace ziggurat::lua {

// As DeviceKind says.
bool has_radios(const ScriptedRobot& robot);
void push_radios(lua_State* state, ScriptedRobot& robot);
void refresh_radios(lua_State* state, const ScriptedRobot& robot);

}  // namespace ziggurat::lua
