#pragma once
// What a script finds when it begins: the standard libraries, robot, log, logerr.

#include <lua.hpp>
#include <string>

#include "script/log_lines.h"
#include "script/random_stream.h"
#include "ziggurat/robot.h"

namespace ziggurat::lua {

/// A robot's streams: one for each library, so that drawing from one does not change the other.
struct RandomStreams {
  RandomStreams(std::uint64_t seed, const std::string& robot)
      : robot_random(seed, "lua/robot.random/" + robot),
        math_random(seed, "lua/math.random/" + robot) {}

  RandomStream robot_random;
  RandomStream math_random;
};

/// Where the pieces of a script's world live. All of it outlives the state, at the same place.
struct Environment {
  Robot& robot;
  LogLines& log;
  RandomStreams& random;
  const std::string& folder;  ///< of the script; modules are looked for there first
};

/// Opens the libraries and sets the globals. May raise a Lua error.
void set_up(lua_State* state, const Environment& environment);

/// Pushes a table with the robot's id, params and devices. The robot outlives the state and does
/// not move; a state may have several. May raise a Lua error.
void push_robot(lua_State* state, Robot& robot);

/// Writes what the robot senses into its tables. May raise a Lua error.
void refresh(lua_State* state, Robot& robot);

}  // namespace ziggurat::lua
