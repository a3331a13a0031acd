// SPDX-License-Identifier: MIT
// robot.battery: available_charge, time_left

#include "devices/device_table.h"
#include "script/tables.h"

namespace ziggurat::lua {
namespace {

void make_battery(lua_State* state, Robot&) { lua_createtable(state, 0, 2); }

void fill_battery(lua_State* state, Robot& robot) {
  set_number(state, "available_charge", robot.battery()->available_charge);
  set_number(state, "time_left", robot.battery()->time_left);
}

}  // namespace

extern const DeviceKind battery_kind{
    "battery", [](Robot& robot) { return robot.battery() != nullptr; }, make_battery, fill_battery};

}  // namespace ziggurat::lua
