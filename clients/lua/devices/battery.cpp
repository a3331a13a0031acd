#include "devices/battery.h"

#include "devices/kept.h"

namespace ziggurat::lua {
namespace {

// What is kept under its address: the table.
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
  keep(state, &key, robot);
}

void refresh_battery(lua_State* state, const ScriptedRobot& robot) {
  push_kept(state, &key, robot);
  fill(state, *robot.battery);
  lua_pop(state, 1);
}

}  // namespace ziggurat::lua
