// SPDX-License-Identifier: MIT
#include "script/environment.h"

#include <cstring>

#include "script/guarded.h"
#include "script/log_functions.h"
#include "script/math_random.h"
#include "script/older_functions.h"
#include "script/ordered_pairs.h"
#include "script/sandbox.h"
#include "script/stuck_call.h"
#include "script/vectors.h"
#include "script/watched_functions.h"

namespace ziggurat::lua {
namespace {

int refuse_exit(lua_State* state) {
  return luaL_error(state,
                    "os.exit is not allowed, as it ends other robots' controllers too; "
                    "error(message) ends this one");
}

// The locale belongs to the process. Other locales give nil, as unknown ones do in Lua.
int keep_locale(lua_State* state) {
  const char* const wanted = luaL_optstring(state, 1, nullptr);
  const bool is_c = wanted == nullptr || *wanted == '\0' || std::strcmp(wanted, "C") == 0;
  if (is_c) {
    lua_pushstring(state, "C");
  } else {
    lua_pushnil(state);
  }
  return 1;
}

// Replaces the functions of the standard libraries that would affect other robots or depend on
// them.
void confine_libraries(lua_State* state, RandomStream& math_random) {
  lua_getglobal(state, LUA_OSLIBNAME);
  set_function<refuse_exit>(state, "exit", nullptr);
  set_function<keep_locale>(state, "setlocale", nullptr);
  lua_pop(state, 1);
  set_math_random(state, math_random);
  set_older_format(state);
  set_vectors(state);
  set_ordered_pairs(state);
  set_watched_functions(state);
  mark_leavable_functions(state);
}

void prepend_to_package_path(lua_State* state, const std::string& folder) {
  lua_getglobal(state, LUA_LOADLIBNAME);
  lua_getfield(state, -1, "path");
  const char* const former = lua_tostring(state, -1);
  const char* const at = folder.c_str();
  lua_pushfstring(state, "%s/?.lua;%s/?/init.lua;%s", at, at, former);
  lua_setfield(state, -3, "path");
  lua_pop(state, 2);
}

}  // namespace

void open_libraries(lua_State* state, const Environment& environment) {
  luaL_openlibs(state);
  confine_libraries(state, environment.random.math_random);
  if (environment.files != nullptr) confine(state, *environment.files, environment.most_files);
  set_older_names(state);
  prepend_to_package_path(state, environment.folder);
  lua_pushglobaltable(state);
  set_log_functions(state, environment.log);
  lua_pop(state, 1);
}

}  // namespace ziggurat::lua
