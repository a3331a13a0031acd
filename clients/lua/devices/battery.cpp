#include "devices/battery.h"

namespace ziggurat::lua {
namespace {

// Its address is where the registry keeps the table.
constexpr char key = 0;

void fill(lua_State* state, const Battery& battery) {
  lua_pushnumber(state, battery.available_charge);
  lua_setfield(state, -2, "available_charge");
  lua_pushnumber(state, battery.time_left);
  lua_setfield(state, -2, "time_left");
}

}  // namespace

bool has_battery(const ScriptedRobot& robot) { return robot.battery.has_value(); }

void push_battery(lua_State* state, ScriptedRobot& robot) {
  lua_createtable(state, 0, 2);
  fill(state, *robot.battery);
  lua_pushvalue(state, -1);
  lua_rawsetp(state, LUA_REGISTRYINDEX, &key);
}

void refresh_battery(lua_State* state, const ScriptedRobot& robot) {
  lua_rawgetp(state, LUA_REGISTRYINDEX, &key);
  fill(state, *robot.battery);
  lua_pop(state, 1);
}

}  // namespace ziggurat::lua
