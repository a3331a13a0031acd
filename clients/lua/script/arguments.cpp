// SPDX-License-Identifier: MIT
#include "script/arguments.h"

#include <cmath>

#include "script/bytes.h"

namespace ziggurat::lua {
namespace {

/// Whether the first argument is the table that the function is a field of, as a colon passes it.
bool is_called_with_colon(lua_State* state) {
  lua_Debug call;
  if (!lua_istable(state, 1) || lua_getstack(state, 0, &call) == 0) return false;
  luaL_checkstack(state, 4, nullptr);
  lua_getinfo(state, "f", &call);
  const int function = lua_gettop(state);
  bool is_field = false;
  lua_pushnil(state);
  while (!is_field && lua_next(state, 1) != 0) {
    is_field = lua_rawequal(state, -1, function) != 0;
    lua_pop(state, 1);
  }
  lua_settop(state, function - 1);
  return is_field;
}

/// Advice for the call.
const char* hint(lua_State* state) {
  return is_called_with_colon(state) ? "; write a dot, not a colon, before the function's name"
                                     : "";
}

void check_type(lua_State* state, int index, int type) {
  if (lua_type(state, index) == type) return;
  const char* message = lua_pushfstring(state, "%s expected, got %s%s", lua_typename(state, type),
                                        luaL_typename(state, index), hint(state));
  luaL_argerror(state, index, message);
}

}  // namespace

void check_count(lua_State* state, int min, int max, const char* usage) {
  const int count = lua_gettop(state);
  if (count >= min && count <= max) return;
  luaL_error(state, "wrong number of arguments: %s expected, got %d%s", usage, count, hint(state));
}

double check_number(lua_State* state, int index) {
  check_type(state, index, LUA_TNUMBER);
  const double number = lua_tonumber(state, index);
  if (!std::isfinite(number)) luaL_argerror(state, index, "finite number expected, got inf or nan");
  return number;
}

lua_Integer check_floored(lua_State* state, int index) {
  const double number = check_number(state, index);
  if (lua_isinteger(state, index)) return lua_tointeger(state, index);
  lua_Integer floored = 0;
  if (!lua_numbertointeger(std::floor(number), &floored)) {
    luaL_argerror(state, index, "number too large for an integer");
  }
  return floored;
}

std::size_t check_position(lua_State* state, int index, std::size_t count, const char* devices) {
  const double position = std::trunc(check_number(state, index));
  if (position >= 1 && position <= static_cast<double>(count)) {
    return static_cast<std::size_t>(position) - 1;
  }
  lua_pushvalue(state, index);
  const char* message =
      lua_pushfstring(state, "no such position: %s; this robot has %d %s, counted from 1",
                      lua_tostring(state, -1), static_cast<int>(count), devices);
  luaL_argerror(state, index, message);
  return 0;  // not reached
}

std::uint8_t check_byte(lua_State* state, int index) {
  check_number(state, index);
  return *to_byte(state, index);
}

std::string_view check_text(lua_State* state, int index) {
  check_type(state, index, LUA_TSTRING);
  std::size_t size = 0;
  const char* const text = lua_tolstring(state, index, &size);
  return {text, size};
}

void check_table(lua_State* state, int index) { check_type(state, index, LUA_TTABLE); }

}  // namespace ziggurat::lua
