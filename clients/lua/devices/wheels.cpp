// SPDX-License-Identifier: MIT
// robot.wheels: set_velocity(left, right), velocity_left, … axis_length

#include "devices/device_table.h"
#include "script/arguments.h"
#include "script/guarded.h"
#include "script/tables.h"

namespace ziggurat::lua {
namespace {

int set_velocity(lua_State* state) {
  check_count(state, 2, 2, "set_velocity(left, right)");
  const double left = check_number(state, 1);
  const double right = check_number(state, 2);
  upvalue<Wheels>(state).set_velocity(left / centimetres, right / centimetres);
  return 0;
}

void make_wheels(lua_State* state, Robot& robot) {
  Wheels& wheels = *robot.wheels();
  lua_createtable(state, 0, 6);
  if (wheels.drives()) set_function<set_velocity>(state, "set_velocity", &wheels);
  set_number(state, "axis_length", wheels.axle_length() * centimetres);
}

void fill_wheels(lua_State* state, Robot& robot) {
  if (!robot.wheels()->measures()) return;
  const Wheels::Reading& reading = robot.wheels()->reading();
  set_number(state, "velocity_left", reading.velocity_left * centimetres);
  set_number(state, "velocity_right", reading.velocity_right * centimetres);
  set_number(state, "distance_left", reading.distance_left * centimetres);
  set_number(state, "distance_right", reading.distance_right * centimetres);
}

}  // namespace

extern const DeviceKind wheels_kind{
    "wheels", [](Robot& robot) { return robot.wheels() != nullptr; }, make_wheels, fill_wheels};

}  // namespace ziggurat::lua
