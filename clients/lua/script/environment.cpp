#include "script/environment.h"

#include <cstring>

#include "devices/device_table.h"
#include "script/guarded.h"
#include "script/log_functions.h"
#include "script/math_random.h"
#include "script/metric_function.h"
#include "script/ordered_pairs.h"
#include "script/robot_random.h"
#include "script/sandbox.h"
#include "script/tables.h"
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
  set_ordered_pairs(state);
  set_watched_functions(state);
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

void push_params(lua_State* state, const Robot& robot) {
  lua_createtable(state, 0, static_cast<int>(robot.params().size()));
  for (const auto& [name, value] : robot.params()) {
    lua_pushlstring(state, value.data(), value.size());
    set_element(state, -2, name);
  }
}

/// Sets robot.<name>, and in the table `kept` what its fill() gets. The table of the robot is
/// beneath that table, which is on top.
void add_devices(lua_State* state, const DeviceKind& kind, Robot& robot) {
  const int kept = lua_gettop(state);
  kind.make(state, robot);
  if (lua_gettop(state) == kept + 1) lua_pushvalue(state, -1);
  if (kind.fill != nullptr) kind.fill(state, robot);
  lua_rawsetp(state, kept, &kind);
  lua_setfield(state, kept - 1, kind.name);
}

}  // namespace

// The registry has a table for each robot, under the robot's address: a state may have several.
void push_robot(lua_State* state, Robot& robot) {
  lua_newtable(state);
  lua_pushlstring(state, robot.id().data(), robot.id().size());
  lua_setfield(state, -2, "id");
  push_params(state, robot);
  lua_setfield(state, -2, "params");
  set_metric_function(state, robot);
  lua_newtable(state);
  for (const DeviceKind* kind : device_kinds()) {
    if (kind->is_present(robot)) add_devices(state, *kind, robot);
  }
  lua_rawsetp(state, LUA_REGISTRYINDEX, &robot);
}

void set_up(lua_State* state, const Environment& environment) {
  luaL_openlibs(state);
  confine_libraries(state, environment.random.math_random);
  if (environment.files != nullptr) confine(state, *environment.files);
  prepend_to_package_path(state, environment.folder);
  lua_pushglobaltable(state);
  set_log_functions(state, environment.log);
  set_metric_function(state, environment.robot);
  lua_pop(state, 1);
  push_robot(state, environment.robot);
  push_robot_random(state, environment.random.robot_random);
  lua_setfield(state, -2, "random");
  lua_pushinteger(state, static_cast<lua_Integer>(environment.first_tick));
  lua_setfield(state, -2, "first_tick");
  lua_setglobal(state, "robot");
}

void refresh(lua_State* state, Robot& robot) {
  lua_rawgetp(state, LUA_REGISTRYINDEX, &robot);
  for (const DeviceKind* kind : device_kinds()) {
    if (kind->fill == nullptr || !kind->is_present(robot)) continue;
    lua_rawgetp(state, -1, kind);
    kind->fill(state, robot);
    lua_pop(state, 1);
  }
  lua_pop(state, 1);
}

}  // namespace ziggurat::lua
