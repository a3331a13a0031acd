#include "script/environment.h"

#include <cstring>

#include "devices/device_table.h"
#include "script/guarded.h"
#include "script/log_functions.h"
#include "script/math_random.h"
#include "script/ordered_pairs.h"
#include "script/robot_random.h"

namespace ziggurat::lua {
namespace {

int refuse_exit(lua_State* state) {
  return luaL_error(state,
                    "os.exit would end the controllers of other robots too; "
                    "error(message) ends this one");
}

// The locale belongs to the process. Like Lua's with a locale that does not exist: nil.
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

// Functions of the standard libraries that reach beyond the robot, or whose results do.
void confine_libraries(lua_State* state, RandomStream& math_random) {
  lua_getglobal(state, LUA_OSLIBNAME);
  set_function<refuse_exit>(state, "exit", nullptr);
  set_function<keep_locale>(state, "setlocale", nullptr);
  lua_pop(state, 1);
  set_math_random(state, math_random);
  set_ordered_pairs(state);
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

void push_params(lua_State* state, const ScriptedRobot& robot) {
  lua_createtable(state, 0, static_cast<int>(robot.params.size()));
  for (const auto& [name, value] : robot.params) {
    lua_pushlstring(state, name.data(), name.size());
    lua_pushlstring(state, value.data(), value.size());
    lua_rawset(state, -3);
  }
}

}  // namespace

void push_robot(lua_State* state, ScriptedRobot& robot) {
  lua_newtable(state);
  lua_pushlstring(state, robot.id.data(), robot.id.size());
  lua_setfield(state, -2, "id");
  push_params(state, robot);
  lua_setfield(state, -2, "params");
  for (const DeviceKind& kind : device_kinds()) {
    if (!kind.is_present(robot)) continue;
    kind.push(state, robot);
    lua_setfield(state, -2, kind.name);
  }
}

void set_up(lua_State* state, const Environment& environment) {
  luaL_openlibs(state);
  confine_libraries(state, environment.random.math_random);
  prepend_to_package_path(state, environment.folder);
  lua_pushglobaltable(state);
  set_log_functions(state, environment.robot.log);
  lua_pop(state, 1);
  push_robot(state, environment.robot);
  push_robot_random(state, environment.random.robot_random);
  lua_setfield(state, -2, "random");
  lua_setglobal(state, "robot");
}

void refresh(lua_State* state, const ScriptedRobot& robot) {
  for (const DeviceKind& kind : device_kinds()) {
    if (kind.is_present(robot)) kind.refresh(state, robot);
  }
}

}  // namespace ziggurat::lua
