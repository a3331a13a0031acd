#pragma once
// robot.cameras.<id>: led_detector, directional_led_detector, tag_detector, image, and where and
// how the camera looks

#include <lua.hpp>

#include "script/scripted_robot.h"

namespace ziggurat::lua {

// As DeviceKind says.
bool has_cameras(const ScriptedRobot& robot);
void push_cameras(lua_State* state, ScriptedRobot& robot);
void refresh_cameras(lua_State* state, const ScriptedRobot& robot);

}  // namespace ziggurat::lua
