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

void append_bytes(lua_State* state, int index, std::size_t count,
                  std::vector<std::uint8_t>& bytes) {
  const std::size_t before = bytes.size();
  bytes.resize(before + count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto position = static_cast<lua_Integer>(i + 1);
    lua_rawgeti(state, index, position);
    if (const auto byte = to_byte(state, -1)) {
      bytes[before + i] = *byte;
    } else {
      bytes.resize(before);
      const bool is_number = lua_type(state, -1) == LUA_TNUMBER;
      luaL_error(state, "finite number expected as element %I of the table, got %s",
                 static_cast<LUAI_UACINT>(position),
                 is_number ? "inf or nan" : luaL_typename(state, -1));
    }
    lua_pop(state, 1);
  }
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
