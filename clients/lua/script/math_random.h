// SPDX-License-Identifier: MIT
#pragma once
// math.random and math.randomseed. Lua's own functions share one state per process: a robot's
// numbers would depend on the other robots in it.

#include <lua.hpp>

#include "script/random_stream.h"

namespace ziggurat::lua {

/// Replaces both by functions with the same meaning that use `stream`; randomseed(x) restarts it.
void set_math_random(lua_State* state, RandomStream& stream);

}  // namespace ziggurat::lua
