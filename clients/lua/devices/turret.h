#pragma once
// robot.turret: rotation, set_rotation(…), set_rotation_speed(…), set_…_mode()

#include <lua.hpp>

#include "script/scripted_robot.h"

namespace ziggurat::lua {

// As DeviceKind says.
bool has_turret(const ScriptedRobot& robot);
void push_turret(lua_State* state, ScriptedRobot& robot);
void refresh_turret(lua_State* state, const ScriptedRobot& robot);

}  // namespace ziggurat::lua
