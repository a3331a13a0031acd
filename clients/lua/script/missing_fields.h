#pragma once
// Which field of `robot` or `world` a script read that is not there: an error says it, with what is there.

#include <lua.hpp>
#include <string>
#include <string_view>

namespace ziggurat::lua {

/// From now on absent fields of the table on top, and of tables in it, are remembered when they are read. They are nil
/// as before. Tables that have a metatable are left alone. May raise a Lua error.
/// @param name  of the table in messages: `robot`
/// @param kind, id  of whom it belongs to: `robot`, `r0`
void watch_missing_fields(lua_State* state, const char* name, const char* kind, const char* id);

/// The sentence on the field that an error is about, as "robot 'r0' has no robot.radios; robot has: joints, leds".
/// Empty if the error is about something else. Allocates no Lua memory.
std::string missing_field(lua_State* state, std::string_view error);

}  // namespace ziggurat::lua
