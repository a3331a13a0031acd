// SPDX-License-Identifier: MIT
#include "script/error_message.h"

#include <cstddef>

namespace ziggurat::lua {
namespace {

constexpr std::size_t max_text = 8192;
constexpr char key = 0;  // its address is where the registry keeps the traceback

std::string shortened(lua_State* state, int index) {
  std::size_t size = 0;
  const char* const text = lua_tolstring(state, index, &size);
  if (size <= max_text) return std::string(text, size);
  return std::string(text, max_text) + "...";
}

}  // namespace

void prepare_error_messages(lua_State* state) {
  lua_pushboolean(state, 0);
  lua_rawsetp(state, LUA_REGISTRYINDEX, &key);
}

int keep_traceback(lua_State* state) {
  if (!lua_isstring(state, 1)) {
    if (luaL_getmetafield(state, 1, "__tostring") != LUA_TNIL) {
      luaL_tolstring(state, 1, nullptr);
    } else {
      lua_pushfstring(state, "(the error is a %s value)", luaL_typename(state, 1));
    }
    lua_replace(state, 1);
  }
  lua_settop(state, 1);
  luaL_traceback(state, state, nullptr, 1);
  lua_rawsetp(state, LUA_REGISTRYINDEX, &key);
  lua_tostring(state, 1);
  return 1;
}

// Allocates no Lua memory: there may be none left.
ErrorMessage take_error_message(lua_State* state) {
  ErrorMessage message;
  message.text = lua_type(state, -1) == LUA_TSTRING ? shortened(state, -1) : "unknown error";
  lua_rawgetp(state, LUA_REGISTRYINDEX, &key);
  if (lua_type(state, -1) == LUA_TSTRING) message.traceback = shortened(state, -1);
  lua_pushboolean(state, 0);
  lua_rawsetp(state, LUA_REGISTRYINDEX, &key);
  lua_pop(state, 2);
  return message;
}

}  // namespace ziggurat::lua
