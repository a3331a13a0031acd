#pragma once
// What ziggurat.connect is given.

#include <lua.hpp>

#include "ziggurat/session.h"

namespace ziggurat::lua {

/// Of the table at stack index 1, or of the environment where that says nothing. Raises a Lua error
/// for what is not as docs/lua-module.md says.
void check_options(lua_State* state);

/// Of a table that check_options() has passed. Raises nothing.
Options take_options(lua_State* state);

}  // namespace ziggurat::lua
