// SPDX-License-Identifier: MIT
#include "script/robot_table.h"

#include "devices/described_devices.h"
#include "devices/device_table.h"
#include "script/metric_function.h"
#include "script/tables.h"

namespace ziggurat::lua {
namespace {

constexpr char described_key = 0;  // its address is a key beside those of the kinds

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
  push_params(state, robot.params());
  lua_setfield(state, -2, "params");
  set_metric_function(state, robot);
  lua_newtable(state);
  for (const DeviceKind* kind : device_kinds()) {
    if (kind->is_present(robot)) add_devices(state, *kind, robot);
  }
  lua_insert(state, -2);  // the robot's table on top
  make_described(state, robot);
  lua_rawsetp(state, -3, &described_key);
  lua_insert(state, -2);
  lua_rawsetp(state, LUA_REGISTRYINDEX, &robot);
}

void refresh_robot(lua_State* state, Robot& robot) {
  lua_rawgetp(state, LUA_REGISTRYINDEX, &robot);
  for (const DeviceKind* kind : device_kinds()) {
    if (kind->fill == nullptr || !kind->is_present(robot)) continue;
    lua_rawgetp(state, -1, kind);
    kind->fill(state, robot);
    lua_pop(state, 1);
  }
  lua_rawgetp(state, -1, &described_key);
  fill_described(state, robot);
  lua_pop(state, 2);
}

}  // namespace ziggurat::lua
