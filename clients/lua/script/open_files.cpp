// SPDX-License-Identifier: MIT
#include "script/open_files.h"

namespace ziggurat::lua {
namespace {

const char files_key = 0;  // its address, in the registry: a table with files as weak keys
const char most_key = 0;   // the bound

/// Files of the table on top that are open; others leave it.
std::size_t count_open(lua_State* state) {
  std::size_t open = 0;
  lua_pushnil(state);
  while (lua_next(state, -2) != 0) {
    lua_pop(state, 1);
    if (static_cast<const luaL_Stream*>(lua_touserdata(state, -1))->closef != nullptr) {
      ++open;
      continue;
    }
    lua_pushvalue(state, -1);
    lua_pushnil(state);
    lua_rawset(state, -4);
  }
  return open;
}

std::size_t most_files(lua_State* state) {
  lua_rawgetp(state, LUA_REGISTRYINDEX, &most_key);
  const auto most = static_cast<std::size_t>(lua_tointeger(state, -1));
  lua_pop(state, 1);
  return most;
}

}  // namespace

void limit_open_files(lua_State* state, std::size_t most) {
  lua_pushinteger(state, static_cast<lua_Integer>(most));
  lua_rawsetp(state, LUA_REGISTRYINDEX, &most_key);
  lua_newtable(state);
  lua_newtable(state);
  // Not weak values: those would leave the table before their finalizers close them.
  lua_pushliteral(state, "k");
  lua_setfield(state, -2, "__mode");
  lua_setmetatable(state, -2);
  lua_rawsetp(state, LUA_REGISTRYINDEX, &files_key);
}

bool may_open_file(lua_State* state) {
  const std::size_t most = most_files(state);
  lua_rawgetp(state, LUA_REGISTRYINDEX, &files_key);
  std::size_t open = count_open(state);
  if (open >= most) {
    lua_gc(state, LUA_GCCOLLECT, 0);
    open = count_open(state);
  }
  lua_pop(state, 1);
  return open < most;
}

void count_open_file(lua_State* state, int index) {
  if (luaL_testudata(state, index, LUA_FILEHANDLE) == nullptr) return;
  lua_pushvalue(state, index);
  lua_rawgetp(state, LUA_REGISTRYINDEX, &files_key);
  lua_insert(state, -2);
  lua_pushboolean(state, 1);
  lua_rawset(state, -3);
  lua_pop(state, 1);
}

void push_too_many_files(lua_State* state, const char* file) {
  lua_pushfstring(state,
                  "'%s' is not opened: this script has %d files open, and may not have more; close "
                  "those that it does "
                  "not need (file:close()); --trust-scripts allows more",
                  file, static_cast<int>(most_files(state)));
}

}  // namespace ziggurat::lua
