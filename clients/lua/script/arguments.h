// SPDX-License-Identifier: MIT
#pragma once
// Checks of a function's arguments. Strict: "1" is not a number. They raise a Lua error that names
// the function, the argument and what is allowed.

#include <cstddef>
#include <cstdint>
#include <lua.hpp>
#include <string_view>

namespace ziggurat::lua {

/// Between `min` and `max` arguments. `usage` shows what is allowed, for example
/// "set_target(target)".
void check_count(lua_State* state, int min, int max, const char* usage);

/// A finite number; integers and floats alike.
double check_number(lua_State* state, int index);

/// A finite number, rounded down to an integer.
lua_Integer check_floored(lua_State* state, int index);

/// The position of one of `count` `devices` ("LEDs"): a finite number, truncated, from 1 to
/// `count`. Returns it counted from 0.
std::size_t check_position(lua_State* state, int index, std::size_t count, const char* devices);

/// A finite number as a byte: truncated toward zero, then modulo 256.
std::uint8_t check_byte(lua_State* state, int index);

/// A string, any bytes; valid while it is on the stack.
std::string_view check_text(lua_State* state, int index);

void check_table(lua_State* state, int index);

}  // namespace ziggurat::lua
