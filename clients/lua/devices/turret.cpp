// SPDX-License-Identifier: MIT
// robot.turret: rotation, set_rotation(…), set_rotation_speed(…), set_…_mode()

#include <cmath>
#include <numbers>

#include "devices/device_table.h"
#include "script/arguments.h"
#include "script/guarded.h"
#include "script/tables.h"

namespace ziggurat::lua {
namespace {

constexpr double radians_per_second = std::numbers::pi / 30;  // in a turn per minute

int set_rotation(lua_State* state) {
  check_count(state, 1, 1, "set_rotation(angle)");
  upvalue<Turret>(state).set_rotation(check_number(state, 1));
  return 0;
}

int set_rotation_speed(lua_State* state) {
  check_count(state, 1, 1, "set_rotation_speed(turns_per_minute)");
  const double turns_per_minute = std::trunc(check_number(state, 1));
  upvalue<Turret>(state).set_rotation_speed(turns_per_minute * radians_per_second);
  return 0;
}

int set_position_control_mode(lua_State* state) {
  check_count(state, 0, 0, "set_position_control_mode()");
  upvalue<Turret>(state).set_mode(TurretMode::position);
  return 0;
}

int set_speed_control_mode(lua_State* state) {
  check_count(state, 0, 0, "set_speed_control_mode()");
  upvalue<Turret>(state).set_mode(TurretMode::speed);
  return 0;
}

int set_passive_mode(lua_State* state) {
  check_count(state, 0, 0, "set_passive_mode()");
  upvalue<Turret>(state).set_mode(TurretMode::passive);
  return 0;
}

void make_turret(lua_State* state, Robot& robot) {
  Turret& turret = *robot.turret();
  lua_createtable(state, 0, 6);
  if (!turret.drives()) return;
  set_function<set_rotation>(state, "set_rotation", &turret);
  set_function<set_rotation_speed>(state, "set_rotation_speed", &turret);
  set_function<set_position_control_mode>(state, "set_position_control_mode", &turret);
  set_function<set_speed_control_mode>(state, "set_speed_control_mode", &turret);
  set_function<set_passive_mode>(state, "set_passive_mode", &turret);
}

void fill_turret(lua_State* state, Robot& robot) {
  if (robot.turret()->measures()) set_number(state, "rotation", robot.turret()->rotation());
}

}  // namespace

extern const DeviceKind turret_kind{
    "turret", [](Robot& robot) { return robot.turret() != nullptr; }, make_turret, fill_turret};

}  // namespace ziggurat::lua
