// SPDX-License-Identifier: MIT
// robot.imus.<id>: acceleration, angular_velocity, both {x, y, z}

#include "devices/device_table.h"
#include "script/tables.h"

namespace ziggurat::lua {
namespace {

/// Second, an array of the vectors of all IMUs: two of each.
void make_imus(lua_State* state, Robot& robot) {
  const int count = static_cast<int>(robot.imus().size());
  lua_createtable(state, 0, count);      // robot.imus
  lua_createtable(state, 2 * count, 0);  // the array
  lua_Integer position = 0;
  for (const Imu& imu : robot.imus()) {
    lua_createtable(state, 0, 2);
    for (const char* name : {"acceleration", "angular_velocity"}) {
      lua_createtable(state, 0, 3);
      lua_pushvalue(state, -1);
      lua_rawseti(state, -4, ++position);
      lua_setfield(state, -2, name);
    }
    set_element(state, -3, imu.id());
  }
}

void fill_imus(lua_State* state, Robot& robot) {
  lua_Integer position = 0;
  for (const Imu& imu : robot.imus()) {
    for (const auto* vector : {&imu.acceleration(), &imu.angular_velocity()}) {
      lua_rawgeti(state, -1, ++position);
      set_vector(state, *vector);
      lua_pop(state, 1);
    }
  }
}

}  // namespace

extern const DeviceKind imus_kind{"imus", [](Robot& robot) { return !robot.imus().empty(); },
                                  make_imus, fill_imus};

}  // namespace ziggurat::lua
