#pragma once
// robot.tags: set_single_payload(i, payload), set_all_payloads(payload)

#include <lua.hpp>

#include "script/scripted_robot.h"

namespace ziggurat::lua {

// As DeviceKind says; nothing is sensed.
bool has_tags(const ScriptedRobot& robot);
void push_tags(lua_State* state, ScriptedRobot& robot);

}  // namespace ziggurat::lua
