#pragma once
// robot.joints.<id>: encoder, set_target(target)

#include <lua.hpp>

#include "script/scripted_robot.h"

namespace ziggurat::lua {

// As DeviceKind says.
bool has_joints(const ScriptedRobot& robot);
void push_joints(lua_State* state, ScriptedRobot& robot);
void refresh_joints(lua_State* state, const ScriptedRobot& robot);

}  // namespace ziggurat::lua
