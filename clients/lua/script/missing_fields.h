// SPDX-License-Identifier: MIT
#pragma once
// Why a value is nil that an error is about: which field of `robot` or `world`, or which global, a
// script read that is not there, and what io.open said.

#include <lua.hpp>
#include <string>
#include <string_view>

namespace ziggurat::lua {

/// From now on absent fields of the table on top, and of tables in it, and absent globals are
/// remembered when they are read. They are nil as before. Tables that have a metatable are left
/// alone. May raise a Lua error.
/// @param name  of the table in messages: `robot`
/// @param kind, id  of whom it belongs to: `robot`, `r0`
void watch_missing_fields(lua_State* state, const char* name, const char* kind, const char* id);

/// Forgets the fields that were read before: the script is called again.
void forget_missing_fields(lua_State* state);

/// io.open has returned nil, and the message at that index; 0: it has opened a file. May raise a
/// Lua error.
void note_opening(lua_State* state, int message);

/// The sentence on the value that an error is about, as "robot 'r0' has no robot.radios; robot has:
/// joints, leds". Empty if the error is about something else. Allocates no Lua memory.
std::string why_nil(lua_State* state, std::string_view error);

}  // namespace ziggurat::lua
