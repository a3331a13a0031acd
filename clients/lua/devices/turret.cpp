#include "devices/turret.h"

#include <cmath>
#include <numbers>

#include "devices/kept.h"
#include "script/arguments.h"
#include "script/guarded.h"
#include "script/vectors.h"

namespace ziggurat::lua {
namespace {

// What is kept under its address: the table.
constexpr char key = 0;

constexpr double radians_per_second = std::numbers::pi / 30;  // in a turn per minute

int set_rotation(lua_State* state) {
  check_count(state, 1, 1, "set_rotation(angle)");
  upvalue<Turret>(state).target.set(check_number(state, 1));
  return 0;
}

int set_rotation_speed(lua_State* state) {
  check_count(state, 1, 1, "set_rotation_speed(turns_per_minute)");
  const double turns_per_minute = std::trunc(check_number(state, 1));
  upvalue<Turret>(state).speed.set(turns_per_minute * radians_per_second);
  return 0;
}

int set_position_control_mode(lua_State* state) {
  check_count(state, 0, 0, "set_position_control_mode()");
  upvalue<Turret>(state).mode.set(TurretMode::position);
  return 0;
}

int set_speed_control_mode(lua_State* state) {
  check_count(state, 0, 0, "set_speed_control_mode()");
  upvalue<Turret>(state).mode.set(TurretMode::speed);
  return 0;
}

int set_passive_mode(lua_State* state) {
  check_count(state, 0, 0, "set_passive_mode()");
  upvalue<Turret>(state).mode.set(TurretMode::passive);
  return 0;
}

}  // namespace

bool has_turret(const ScriptedRobot& robot) { return robot.turret.has_value(); }

void push_turret(lua_State* state, ScriptedRobot& robot) {
  Turret& turret = *robot.turret;
  lua_createtable(state, 0, 6);
  if (turret.has_actuator) {
    set_function<set_rotation>(state, "set_rotation", &turret);
    set_function<set_rotation_speed>(state, "set_rotation_speed", &turret);
    set_function<set_position_control_mode>(state, "set_position_control_mode", &turret);
    set_function<set_speed_control_mode>(state, "set_speed_control_mode", &turret);
    set_function<set_passive_mode>(state, "set_passive_mode", &turret);
  }
  if (turret.has_encoder) set_number(state, "rotation", turret.rotation);
  lua_pushvalue(state, -1);
  keep(state, &key, robot);
}

void refresh_turret(lua_State* state, const ScriptedRobot& robot) {
  if (!robot.turret->has_encoder) return;
  push_kept(state, &key, robot);
  set_number(state, "rotation", robot.turret->rotation);
  lua_pop(state, 1);
}

}  // namespace ziggurat::lua
