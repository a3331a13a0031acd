// SPDX-License-Identifier: MIT
#include "script/older_functions.h"

#include <cmath>
#include <string_view>

namespace ziggurat::lua {
namespace {

/// Cuts off the fraction of the number at that index; an infinite one stays.
void cut_fraction(lua_State* state, int index) {
  if (lua_type(state, index) != LUA_TNUMBER || lua_isinteger(state, index)) return;
  lua_Integer whole = 0;
  if (lua_numbertointeger(std::trunc(lua_tonumber(state, index)), &whole) == 0) return;
  lua_pushinteger(state, whole);
  lua_replace(state, index);
}

constexpr char format_key = 0;  // its address, in the registry: Lua's string.format

// Calls Lua's string.format in this frame, so that its errors name it.
int format(lua_State* state) {
  if (lua_type(state, 1) == LUA_TSTRING) {
    std::size_t size = 0;
    const char* bytes = lua_tolstring(state, 1, &size);
    const std::string_view text(bytes, size);
    int argument = 1;
    for (std::size_t i = text.find('%'); i < text.size(); i = text.find('%', i + 1)) {
      i = text.find_first_not_of("-+ #.0123456789", i + 1);
      if (i == text.npos) break;
      if (text[i] == '%' || ++argument > lua_gettop(state)) continue;
      constexpr std::string_view of_whole = "dioxXc";
      if (of_whole.find(text[i]) != of_whole.npos) cut_fraction(state, argument);
    }
  }
  lua_rawgetp(state, LUA_REGISTRYINDEX, &format_key);
  const lua_CFunction native = lua_tocfunction(state, -1);
  lua_pop(state, 1);
  return native(state);
}

int maxn(lua_State* state) {
  luaL_checktype(state, 1, LUA_TTABLE);
  lua_Number most = 0;
  for (lua_pushnil(state); lua_next(state, 1) != 0; lua_pop(state, 1)) {
    if (lua_type(state, -2) == LUA_TNUMBER) most = std::fmax(most, lua_tonumber(state, -2));
  }
  lua_pushnumber(state, most);
  cut_fraction(state, -1);
  return 1;
}

}  // namespace

void set_older_format(lua_State* state) {
  lua_getglobal(state, LUA_STRLIBNAME);
  lua_getfield(state, -1, "format");
  lua_rawsetp(state, LUA_REGISTRYINDEX, &format_key);
  lua_pushcfunction(state, format);
  lua_setfield(state, -2, "format");
  lua_pop(state, 1);
}

void set_older_names(lua_State* state) {
  lua_getglobal(state, "load");
  lua_setglobal(state, "loadstring");
  lua_getglobal(state, LUA_TABLIBNAME);
  lua_getfield(state, -1, "unpack");
  lua_setglobal(state, "unpack");
  lua_pushcfunction(state, maxn);
  lua_setfield(state, -2, "maxn");
  lua_pop(state, 1);
}

}  // namespace ziggurat::lua
