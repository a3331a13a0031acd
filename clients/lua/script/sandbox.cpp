// SPDX-License-Identifier: MIT
#include "script/sandbox.h"

#include <initializer_list>

#include "script/confined_code.h"
#include "script/confined_files.h"
#include "script/guarded.h"

namespace ziggurat::lua {
namespace {

// Upvalue: the function's name.
int refuse(lua_State* state) {
  return luaL_error(state,
                    "%s is not allowed for scripts that are not trusted; --trust-scripts allows it",
                    lua_tostring(state, lua_upvalueindex(1)));
}

/// Lets functions of a library raise errors.
void forbid(lua_State* state, const char* library, std::initializer_list<const char*> names) {
  lua_getglobal(state, library);
  for (const char* name : names) {
    lua_pushfstring(state, "%s.%s", library, name);
    lua_pushcclosure(state, refuse, 1);
    lua_setfield(state, -2, name);
  }
  lua_pop(state, 1);
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
  forbid(state, LUA_OSLIBNAME, {"execute", "tmpname"});
  forbid(state, LUA_IOLIBNAME, {"popen", "tmpfile"});
  forbid(state, LUA_LOADLIBNAME, {"loadlib"});
  // These reach into other functions and into the registry, and can remove the hook that counts.
  forbid(state, LUA_DBLIBNAME,
         {"debug", "gethook", "getlocal", "getmetatable", "getregistry", "getupvalue",
          "getuservalue", "sethook", "setlocal", "setmetatable", "setupvalue", "setuservalue",
          "upvalueid", "upvaluejoin"});
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
