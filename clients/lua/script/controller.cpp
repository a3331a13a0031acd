// SPDX-License-Identifier: MIT
#include "script/controller.h"

#include "script/metric_function.h"
#include "script/missing_fields.h"
#include "script/robot_random.h"
#include "script/robot_table.h"

namespace ziggurat::lua {

Controller::Controller(Robot& robot, const ScriptOptions& options)
    : Script(robot.id(), options), robot_(robot) {}

Failure Controller::start() {
  const Running running(calling());
  if (auto failure = run_chunk()) return failure;
  return call("init", true, "init, tick " + std::to_string(first_tick()));
}

Failure Controller::step(std::uint64_t tick) {
  const Running running(calling());
  return call("step", true, "step " + std::to_string(tick));
}

Failure Controller::reset(std::uint64_t seed) {
  begin_anew(seed);
  const Running running(calling());
  return call("reset", false, "reset, tick 0");
}

Failure Controller::destroy(std::uint64_t last_tick, std::uint64_t max_seconds) {
  Calling limited = calling();
  limited.max_seconds = max_seconds;
  const Running running(limited);
  if (!has("destroy")) return std::nullopt;  // tables of many readings take long
  return call("destroy", false, "destroy, after tick " + std::to_string(last_tick));
}

void Controller::set_up(lua_State* state) {
  lua_pushglobaltable(state);
  set_metric_function(state, robot_);
  lua_pop(state, 1);
  push_robot(state, robot_);
  push_robot_random(state, random().robot_random);
  lua_setfield(state, -2, "random");
  lua_pushinteger(state, static_cast<lua_Integer>(first_tick()));
  lua_setfield(state, -2, "first_tick");
  watch_missing_fields(state, "robot", "robot", robot_.id().c_str());
  lua_setglobal(state, "robot");
}

void Controller::refresh(lua_State* state) { refresh_robot(state, robot_); }

}  // namespace ziggurat::lua
