#pragma once
// robot.leds and robot.directional_leds: set_single_color(…), set_all_colors(…)

#include <lua.hpp>

#include "script/scripted_robot.h"

namespace ziggurat::lua {

// As DeviceKind says; nothing is sensed.
bool has_leds(const ScriptedRobot& robot);
void push_leds(lua_State* state, ScriptedRobot& robot);
bool has_directional_leds(const ScriptedRobot& robot);
void push_directional_leds(lua_State* state, ScriptedRobot& robot);

}  // namespace ziggurat::lua
