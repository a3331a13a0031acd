// SPDX-License-Identifier: MIT
#pragma once
// Functions of older Luas, for which most scripts of the dialect are written.

#include <lua.hpp>

namespace ziggurat::lua {

/// Makes string.format cut off fractions for %d, as Lua 5.2 does.
void set_older_format(lua_State* state);

/// Sets unpack, loadstring and table.maxn; the first two are what table.unpack and load are now.
void set_older_names(lua_State* state);

}  // namespace ziggurat::lua
