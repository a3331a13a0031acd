#include "devices/wheels.h"

#include "devices/kept.h"
#include "script/arguments.h"
#include "script/guarded.h"
#include "script/vectors.h"

namespace ziggurat::lua {
namespace {

// What is kept under its address: the table.
constexpr char key = 0;

constexpr double centimetres = 100;  // in a metre

int set_velocity(lua_State* state) {
  check_count(state, 2, 2, "set_velocity(left, right)");
  const double left = check_number(state, 1);
  const double right = check_number(state, 2);
  upvalue<Wheels>(state).velocities.set({left / centimetres, right / centimetres});
  return 0;
}

void fill(lua_State* state, const Wheels& wheels) {
  set_number(state, "velocity_left", wheels.velocity_left * centimetres);
  set_number(state, "velocity_right", wheels.velocity_right * centimetres);
  set_number(state, "distance_left", wheels.distance_left * centimetres);
  set_number(state, "distance_right", wheels.distance_right * centimetres);
}

}  // namespace

bool has_wheels(const ScriptedRobot& robot) { return robot.wheels.has_value(); }

void push_wheels(lua_State* state, ScriptedRobot& robot) {
  Wheels& wheels = *robot.wheels;
  lua_createtable(state, 0, 6);
  if (wheels.has_actuator) set_function<set_velocity>(state, "set_velocity", &wheels);
  if (wheels.has_sensor) {
    set_number(state, "axis_length", wheels.axle_length * centimetres);
    fill(state, wheels);
  }
  lua_pushvalue(state, -1);
  keep(state, &key, robot);
}

void refresh_wheels(lua_State* state, const ScriptedRobot& robot) {
  if (!robot.wheels->has_sensor) return;
  push_kept(state, &key, robot);
  fill(state, *robot.wheels);
  lua_pop(state, 1);
}

}  // namespace ziggurat::lua
