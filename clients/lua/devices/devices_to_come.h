#pragma once
// Devices that the scene gives a robot and that do not work yet: empty tables, so that scripts that
// only look at their readings run.

#include <lua.hpp>

#include "ziggurat/robot.h"

namespace ziggurat::lua {

/// Sets their tables in the table `robot`, which is on top.
void set_devices_to_come(lua_State* state, const Robot& robot);

}  // namespace ziggurat::lua
