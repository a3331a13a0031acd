// SPDX-License-Identifier: MIT
#pragma once
// Functions that Lua calls. A Lua error jumps over C++ frames, and an exception must not pass
// through Lua's frames. Therefore:
//  - every function given to Lua is guarded<function>;
//  - no object with a destructor lives across a call of the Lua API that may raise an error.

#include <exception>
#include <lua.hpp>

namespace ziggurat::lua {

/// An exception that leaves `body` becomes a Lua error with the same message.
template <int (*body)(lua_State*)>
int guarded(lua_State* state) {
  try {
    return body(state);
  } catch (const std::exception& error) {
    luaL_where(state, 1);
    lua_pushstring(state, error.what());
  }
  lua_concat(state, 2);
  return lua_error(state);
}

/// Object of a closure's n-th upvalue (from 1), a light userdata.
template <typename T>
T& upvalue(lua_State* state, int n = 1) {
  return *static_cast<T*>(lua_touserdata(state, lua_upvalueindex(n)));
}

/// Sets field `name` of the table on top to a closure over `subject`, which must outlive the state:
/// scripts may keep the function.
template <int (*body)(lua_State*)>
void set_function(lua_State* state, const char* name, void* subject) {
  lua_pushlightuserdata(state, subject);
  lua_pushcclosure(state, guarded<body>, 1);
  lua_setfield(state, -2, name);
}

}  // namespace ziggurat::lua
