// SPDX-License-Identifier: MIT
// robot.contact_sensors.<id>: touches, force {x, y, z}, strength

#include "devices/device_table.h"
#include "script/tables.h"

namespace ziggurat::lua {
namespace {

void fill_one(lua_State* state, const ContactSensor& sensor) {
  lua_pushboolean(state, sensor.touches());
  lua_setfield(state, -2, "touches");
  set_number(state, "strength", sensor.strength());
}

/// Second, an array of the tables of all sensors, each followed by its force.
void make_contact_sensors(lua_State* state, Robot& robot) {
  const int count = static_cast<int>(robot.contact_sensors().size());
  lua_createtable(state, 0, count);      // robot.contact_sensors
  lua_createtable(state, 2 * count, 0);  // the array
  lua_Integer position = 0;
  for (const ContactSensor& sensor : robot.contact_sensors()) {
    lua_createtable(state, 0, 3);
    lua_pushvalue(state, -1);
    lua_rawseti(state, -3, ++position);
    lua_createtable(state, 0, 3);
    lua_pushvalue(state, -1);
    lua_rawseti(state, -4, ++position);
    lua_setfield(state, -2, "force");
    set_element(state, -3, sensor.id());
  }
}

void fill_contact_sensors(lua_State* state, Robot& robot) {
  lua_Integer position = 0;
  for (const ContactSensor& sensor : robot.contact_sensors()) {
    lua_rawgeti(state, -1, ++position);
    fill_one(state, sensor);
    lua_pop(state, 1);
    lua_rawgeti(state, -1, ++position);
    set_vector(state, sensor.force());
    lua_pop(state, 1);
  }
}

}  // namespace

extern const DeviceKind contact_sensors_kind{
    "contact_sensors", [](Robot& robot) { return !robot.contact_sensors().empty(); },
    make_contact_sensors, fill_contact_sensors};

}  // namespace ziggurat::lua
