// SPDX-License-Identifier: MIT
// robot.proximity[i]: a number, or {value, angle} if all sensors have angles

#include <algorithm>

#include "devices/device_table.h"
#include "script/tables.h"

namespace ziggurat::lua {
namespace {

bool has_angles(const Robot& robot) {
  return std::ranges::all_of(robot.proximity_sensors(), [](const ProximitySensor& sensor) {
    return sensor.angle().has_value();
  });
}

/// With angles second, an array of its own with the same tables: scripts may change theirs.
void make_proximity(lua_State* state, Robot& robot) {
  const int count = static_cast<int>(robot.proximity_sensors().size());
  lua_createtable(state, count, 0);
  if (!has_angles(robot)) return;
  lua_createtable(state, count, 0);
  lua_Integer position = 0;
  for (const ProximitySensor& sensor : robot.proximity_sensors()) {
    lua_createtable(state, 0, 2);
    set_number(state, "angle", *sensor.angle());
    lua_pushvalue(state, -1);
    lua_rawseti(state, -4, ++position);
    lua_rawseti(state, -2, position);
  }
}

void fill_proximity(lua_State* state, Robot& robot) {
  const bool are_tables = has_angles(robot);
  lua_Integer position = 0;
  for (const ProximitySensor& sensor : robot.proximity_sensors()) {
    ++position;
    if (are_tables) {
      lua_rawgeti(state, -1, position);
      set_number(state, "value", sensor.reading());
      lua_pop(state, 1);
    } else {
      lua_pushnumber(state, sensor.reading());
      lua_rawseti(state, -2, position);
    }
  }
}

}  // namespace

extern const DeviceKind proximity_kind{
    "proximity", [](Robot& robot) { return !robot.proximity_sensors().empty(); }, make_proximity,
    fill_proximity};

}  // namespace ziggurat::lua
