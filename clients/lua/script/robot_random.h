// SPDX-License-Identifier: MIT
#pragma once
// robot.random

#include <lua.hpp>

#include "script/random_stream.h"

namespace ziggurat::lua {

/// Pushes the table robot.random: bernoulli, uniform, uniform_int, exponential, gaussian, poisson.
void push_robot_random(lua_State* state, RandomStream& stream);

}  // namespace ziggurat::lua
