// SPDX-License-Identifier: MIT
#include "script/sandbox.h"

#include <array>
#include <cstddef>
#include <utility>

#include "script/confined_code.h"
#include "script/confined_files.h"
#include "script/guarded.h"

namespace ziggurat::lua {
namespace {

struct Forbidden {
  const char* table;
  const char* name;
};
// Functions of debug reach into other functions and into the registry, and can remove the hook that
// counts.
constexpr std::array forbidden{
    Forbidden{LUA_OSLIBNAME, "execute"},      Forbidden{LUA_OSLIBNAME, "tmpname"},
    Forbidden{LUA_IOLIBNAME, "popen"},        Forbidden{LUA_IOLIBNAME, "tmpfile"},
    Forbidden{LUA_LOADLIBNAME, "loadlib"},    Forbidden{LUA_DBLIBNAME, "debug"},
    Forbidden{LUA_DBLIBNAME, "gethook"},      Forbidden{LUA_DBLIBNAME, "getlocal"},
    Forbidden{LUA_DBLIBNAME, "getmetatable"}, Forbidden{LUA_DBLIBNAME, "getregistry"},
    Forbidden{LUA_DBLIBNAME, "getupvalue"},   Forbidden{LUA_DBLIBNAME, "getuservalue"},
    Forbidden{LUA_DBLIBNAME, "sethook"},      Forbidden{LUA_DBLIBNAME, "setlocal"},
    Forbidden{LUA_DBLIBNAME, "setmetatable"}, Forbidden{LUA_DBLIBNAME, "setupvalue"},
    Forbidden{LUA_DBLIBNAME, "setuservalue"}, Forbidden{LUA_DBLIBNAME, "upvalueid"},
    Forbidden{LUA_DBLIBNAME, "upvaluejoin"},
};

// A function for each name: closures would take two kilobytes of each robot's state.
template <std::size_t i>
int refuse(lua_State* state) {
  return luaL_error(
      state, "%s.%s is not allowed for scripts that are not trusted; --trust-scripts allows it",
      forbidden[i].table, forbidden[i].name);
}

/// Lets forbidden functions raise errors.
template <std::size_t... i>
void forbid(lua_State* state, std::index_sequence<i...>) {
  constexpr lua_CFunction functions[] = {refuse<i>...};
  for (std::size_t k = 0; k < forbidden.size(); ++k) {
    lua_getglobal(state, forbidden[k].table);
    lua_pushcfunction(state, functions[k]);
    lua_setfield(state, -2, forbidden[k].name);
    lua_pop(state, 1);
  }
}

// The environment may hold keys and passwords.
int hide_variable(lua_State* state) {
  luaL_checkstring(state, 1);
  lua_pushnil(state);
  return 1;
}

// As in Lua, without functions: while one of these here calls Lua's own, that is on the stack, and
// a script's reader or message handler could take it from there. Upvalue: Lua's debug.getinfo. Not
// by lua_call: levels count this function as they count Lua's.
int get_info(lua_State* state) {
  // Lua 5.3 would pop a value from the stack, also of a coroutine, and again until there is none.
  const int option = lua_isthread(state, 1) ? 3 : 2;
  luaL_argcheck(state, *luaL_optstring(state, option, "") != '>', option, "invalid option");
  const int results = lua_tocfunction(state, lua_upvalueindex(1))(state);
  if (results == 1 && lua_istable(state, -1)) {
    lua_pushnil(state);
    lua_setfield(state, -2, "func");
  }
  return results;
}

// As in Lua, without finalizers: no instruction is counted in them.
int set_metatable(lua_State* state) {
  luaL_checktype(state, 1, LUA_TTABLE);
  const int type = lua_type(state, 2);
  luaL_argcheck(state, type == LUA_TNIL || type == LUA_TTABLE, 2, "nil or table expected");
  if (luaL_getmetafield(state, 1, "__metatable") != LUA_TNIL) {
    return luaL_error(state, "cannot change a protected metatable");
  }
  lua_settop(state, 2);
  if (type == LUA_TTABLE) {
    lua_pushliteral(state, "__gc");
    if (lua_rawget(state, 2) != LUA_TNIL) {
      return luaL_error(state,
                        "a metatable with __gc is not allowed for scripts that are not trusted; "
                        "--trust-scripts allows it");
    }
    lua_pop(state, 1);
  }
  lua_setmetatable(state, 1);
  return 1;
}

}  // namespace

void confine(lua_State* state, const Folders& folders, std::size_t most_files) {
  forbid(state, std::make_index_sequence<forbidden.size()>());
  lua_getglobal(state, LUA_DBLIBNAME);
  lua_getfield(state, -1, "getinfo");
  lua_pushcclosure(state, get_info, 1);
  lua_setfield(state, -2, "getinfo");
  lua_pop(state, 1);
  lua_register(state, "setmetatable", set_metatable);
  lua_getglobal(state, LUA_OSLIBNAME);
  lua_pushcfunction(state, hide_variable);
  lua_setfield(state, -2, "getenv");
  lua_pop(state, 1);
  confine_files(state, folders, most_files);
  confine_code(state, folders);
}

}  // namespace ziggurat::lua
