#pragma once
// Checks of what a script gives to a function. Strict: "1" is no number. All of them raise a Lua
// error that names function, argument and what would be right.

#include <cstddef>
#include <cstdint>
#include <lua.hpp>
#include <string_view>

namespace ziggurat::lua {

/// Between `least` and `most` arguments. `usage` says what is right, for example
/// "set_target(target)".
void check_count(lua_State* state, int least, int most, const char* usage);

/// A finite number; integers and floats alike.
double check_number(lua_State* state, int index);

/// A finite number, rounded down to an integer.
lua_Integer check_floored(lua_State* state, int index);

/// A finite number, truncated, from 1 to `count`: the position of one of so many `devices`
/// ("LEDs"). Counts from 0 on this side.
std::size_t check_position(lua_State* state, int index, std::size_t count, const char* devices);

/// A finite number as a byte: truncated toward zero, then modulo 256.
std::uint8_t check_byte(lua_State* state, int index);

/// A string, any bytes; valid as long as it stays where it is.
std::string_view check_text(lua_State* state, int index);

void check_table(lua_State* state, int index);

}  // namespace ziggurat::lua
