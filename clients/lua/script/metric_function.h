// SPDX-License-Identifier: MIT
#pragma once
// metric(name, value)

#include <lua.hpp>

#include "ziggurat/robot.h"

namespace ziggurat::lua {

/// Sets the field `metric` of the table on top. The robot outlives the state.
void set_metric_function(lua_State* state, Robot& robot);

}  // namespace ziggurat::lua
