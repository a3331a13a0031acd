// SPDX-License-Identifier: MIT
#include "script/watched_functions.h"

#include <string_view>

#include "script/interrupt.h"
#include "script/own_code.h"

namespace ziggurat::lua {
namespace {

/// Calls Lua's coroutine.resume, which is on the stack under its arguments.
/// @param index  of the coroutine in the stack
void resume_watched(lua_State* state, int index, int arguments) {
  lua_State* const coroutine = lua_tothread(state, index);
  lua_State* const former = coroutine == nullptr ? nullptr : switch_to(coroutine);
  const int status = lua_pcall(state, arguments, LUA_MULTRET, 0);
  if (coroutine != nullptr) switch_to(former);
  if (status != LUA_OK) lua_error(state);
}

// Upvalue: Lua's coroutine.resume.
int resume(lua_State* state) {
  luaL_argcheck(state, lua_isthread(state, 1), 1, "coroutine expected");
  lua_pushvalue(state, lua_upvalueindex(1));
  lua_insert(state, 1);
  resume_watched(state, 2, lua_gettop(state) - 1);
  return lua_gettop(state);
}

// Upvalues: Lua's coroutine.resume, the coroutine.
int call_wrapped(lua_State* state) {
  lua_pushvalue(state, lua_upvalueindex(1));
  lua_pushvalue(state, lua_upvalueindex(2));
  lua_rotate(state, 1, 2);
  resume_watched(state, 2, lua_gettop(state) - 1);
  if (lua_toboolean(state, 1)) return lua_gettop(state) - 1;
  if (lua_type(state, -1) == LUA_TSTRING) {
    luaL_where(state, 1);
    lua_insert(state, -2);
    lua_concat(state, 2);
  }
  return lua_error(state);
}

// Upvalue: Lua's coroutine.resume.
int wrap(lua_State* state) {
  luaL_checktype(state, 1, LUA_TFUNCTION);
  lua_pushvalue(state, lua_upvalueindex(1));
  lua_State* const coroutine = lua_newthread(state);
  lua_pushvalue(state, 1);
  lua_xmove(state, coroutine, 1);
  lua_pushcclosure(state, call_wrapped, 2);
  return 1;
}

// Upvalue: the script's message handler. It would run inside the hook, where no hook ends it.
int handle_message(lua_State* state) {
  if (must_scripts_end()) return 1;
  lua_pushvalue(state, lua_upvalueindex(1));
  lua_insert(state, 1);
  lua_call(state, 1, 1);
  return 1;
}

int guard_handler(lua_State* state) {
  if (lua_isfunction(state, 1)) lua_pushcclosure(state, handle_message, 1);
  return 1;
}

// In Lua, so that coroutines can yield in it.
constexpr std::string_view guarded_xpcall = R"lua(
local xpcall, guard_handler = ...
return function(f, handler, ...) return xpcall(f, guard_handler(handler), ...) end
)lua";

void set_xpcall(lua_State* state) {
  static const OwnCode code(guarded_xpcall, "=xpcall");
  code.push(state);
  lua_getglobal(state, "xpcall");
  lua_pushcfunction(state, guard_handler);
  lua_call(state, 2, 1);
  lua_setglobal(state, "xpcall");
}

}  // namespace

void set_watched_functions(lua_State* state) {
  set_xpcall(state);
  lua_getglobal(state, LUA_COLIBNAME);
  for (const auto& [name, function] : {luaL_Reg{"wrap", wrap}, luaL_Reg{"resume", resume}}) {
    lua_getfield(state, -1, "resume");
    lua_pushcclosure(state, function, 1);
    lua_setfield(state, -2, name);
  }
  lua_pop(state, 1);
}

}  // namespace ziggurat::lua
