// SPDX-License-Identifier: MIT
#pragma once
// The globals of each script: the standard libraries, log, logerr.

#include <cstddef>
#include <cstdint>
#include <lua.hpp>
#include <string>

#include "script/folders.h"
#include "script/log_lines.h"
#include "script/random_stream.h"

namespace ziggurat::lua {

/// Random streams of a script: one for each library, so that one does not change the other.
struct RandomStreams {
  RandomStreams(std::uint64_t seed, const std::string& name)
      : robot_random(seed, "lua/robot.random/" + name),
        math_random(seed, "lua/math.random/" + name) {}

  RandomStream robot_random;
  RandomStream math_random;
};

/// Environment of the libraries. All of it outlives the state and does not move.
struct Environment {
  LogLines& log;
  RandomStreams& random;
  const std::string& folder;  ///< of the script; the first place to search for modules
  const Folders* files;       ///< those that the script may use; null: it is trusted
  std::size_t most_files;     ///< that it may have open at once, unless it is trusted
};

/// Opens the libraries, and sets log and logerr. May raise a Lua error.
void open_libraries(lua_State* state, const Environment& environment);

}  // namespace ziggurat::lua
