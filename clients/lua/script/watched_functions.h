// SPDX-License-Identifier: MIT
#pragma once
// coroutine.resume, coroutine.wrap and xpcall for interrupt.h: the first two keep note of the
// coroutine that runs, the third calls no message handler of a script that must end.

#include <lua.hpp>

namespace ziggurat::lua {

/// Replaces them by functions with the same meaning. May raise a Lua error.
void set_watched_functions(lua_State* state);

}  // namespace ziggurat::lua
