#pragma once
// Checks of what a script gives to a function. Strict: "1" is no number. All of them raise a Lua
// error that names function, argument and what would be right.

#include <lua.hpp>

namespace ziggurat::lua {

/// Between `least` and `most` arguments. `usage` says what is right, for example
/// "set_target(target)".
void check_count(lua_State* state, int least, int most, const char* usage);

/// A finite number; integers and floats alike.
double check_number(lua_State* state, int index);

/// A finite number, rounded down to an integer.
lua_Integer check_floored(lua_State* state, int index);

}  // namespace ziggurat::lua
