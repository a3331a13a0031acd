// SPDX-License-Identifier: MIT
#pragma once
// The table `world` of a director's script: the entities as they are, and functions that change the
// world.

#include <cstdint>
#include <lua.hpp>

#include "script/act_places.h"
#include "script/log_lines.h"
#include "script/random_stream.h"
#include "ziggurat/director.h"

namespace ziggurat::lua {

/// Parts of the world that the table refers to. All of it outlives the state and does not move.
struct WorldParts {
  Director& director;
  LogLines& log;
  RandomStream& random;
  std::uint64_t first_tick;  ///< at which the script begins
  ActPlaces& places;         ///< gets one for each act
};

/// Pushes it. May raise a Lua error.
void push_world(lua_State* state, const WorldParts& parts);

/// Brings time, tick and the list of entities up to date. May raise a Lua error.
void refresh_world(lua_State* state, Director& director);

}  // namespace ziggurat::lua
