#pragma once
// math.random and math.randomseed. Lua's own draw from the process: what a robot got would depend
// on who else runs in it.

#include <lua.hpp>

#include "script/random_stream.h"

namespace ziggurat::lua {

/// Replaces both by functions of the same meaning that draw from `stream`; randomseed(x) restarts
/// it.
void set_math_random(lua_State* state, RandomStream& stream);

}  // namespace ziggurat::lua
