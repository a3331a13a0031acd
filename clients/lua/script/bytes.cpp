// SPDX-License-Identifier: MIT
#include "script/bytes.h"

#include <cmath>

namespace ziggurat::lua {

std::optional<std::uint8_t> to_byte(lua_State* state, int index) {
  if (lua_type(state, index) != LUA_TNUMBER) return std::nullopt;
  if (lua_isinteger(state, index)) return static_cast<std::uint8_t>(lua_tointeger(state, index));
  const double number = lua_tonumber(state, index);
  if (!std::isfinite(number)) return std::nullopt;
  return static_cast<std::uint8_t>(static_cast<int>(std::fmod(std::trunc(number), 256.0)));
}

void check_bytes(lua_State* state, int index, std::size_t count) {
  for (std::size_t i = 1; i <= count; ++i) {
    const int type = lua_rawgeti(state, index, static_cast<lua_Integer>(i));
    if (!to_byte(state, -1)) {
      luaL_error(state, "finite number expected as element %I of the table, got %s",
                 static_cast<LUAI_UACINT>(i),
                 type == LUA_TNUMBER ? "inf or nan" : lua_typename(state, type));
    }
    lua_pop(state, 1);
  }
}

std::vector<std::uint8_t> to_bytes(lua_State* state, int index, std::size_t count) {
  std::vector<std::uint8_t> bytes(count);
  for (std::size_t i = 0; i < count; ++i) {
    lua_rawgeti(state, index, static_cast<lua_Integer>(i + 1));
    bytes[i] = to_byte(state, -1).value_or(0);
    lua_pop(state, 1);
  }
  return bytes;
}

void push_bytes(lua_State* state, Bytes bytes) {
  lua_createtable(state, static_cast<int>(bytes.size()), 0);
  lua_Integer position = 0;
  for (const std::uint8_t byte : bytes) {
    lua_pushinteger(state, byte);
    lua_rawseti(state, -2, ++position);
  }
}

}  // namespace ziggurat::lua
