#pragma once
// The globals of a script: the standard libraries, robot, log, logerr.

#include <cstdint>
#include <lua.hpp>
#include <string>

#include "script/folders.h"
#include "script/log_lines.h"
#include "script/random_stream.h"
#include "ziggurat/robot.h"

namespace ziggurat::lua {

/// Random streams of a robot: one for each library, so that one does not change the other.
struct RandomStreams {
  RandomStreams(std::uint64_t seed, const std::string& robot)
      : robot_random(seed, "lua/robot.random/" + robot),
        math_random(seed, "lua/math.random/" + robot) {}

  RandomStream robot_random;
  RandomStream math_random;
};

/// What the globals refer to. All of it outlives the state and does not move.
struct Environment {
  Robot& robot;
  LogLines& log;
  RandomStreams& random;
  const std::string& folder;  ///< of the script; the first place to search for modules
  const Folders* files;       ///< those that the script may use; null: it is trusted
  std::uint64_t first_tick;   ///< at which the script begins
};

/// Opens the libraries and sets the globals. May raise a Lua error.
void set_up(lua_State* state, const Environment& environment);

/// Pushes a table with the robot's id, params and devices. The robot outlives the state and does
/// not move; a state may have several robots. May raise a Lua error.
void push_robot(lua_State* state, Robot& robot);

/// Writes the readings of the robot into its tables. May raise a Lua error.
void refresh(lua_State* state, Robot& robot);

}  // namespace ziggurat::lua
