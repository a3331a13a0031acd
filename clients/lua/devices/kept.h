#pragma once
// Tables that refresh() of a kind of device finds again, whatever a script does with robot.<kind>.

#include <lua.hpp>

#include "script/scripted_robot.h"

namespace ziggurat::lua {

/// Keeps the value on top of the stack for this robot, and pops it.
/// @param key  an address of the kind's own
void keep(lua_State* state, const char* key, const ScriptedRobot& robot);

/// Pushes what was kept.
void push_kept(lua_State* state, const char* key, const ScriptedRobot& robot);

}  // namespace ziggurat::lua
