// SPDX-License-Identifier: MIT
#include "script/robot_random.h"

#include <cmath>

#include "script/arguments.h"
#include "script/guarded.h"

namespace ziggurat::lua {
namespace {

RandomStream& stream_of(lua_State* state) { return upvalue<RandomStream>(state); }

void check_order(lua_State* state, bool is_ordered, const char* message) {
  if (!is_ordered) luaL_argerror(state, lua_gettop(state), message);
}

// A number, not a boolean: old scripts compare it with 1.
int bernoulli(lua_State* state) {
  check_count(state, 0, 1, "bernoulli([probability])");
  const double probability = lua_gettop(state) == 0 ? 0.5 : check_number(state, 1);
  lua_pushinteger(state, stream_of(state).unit() < probability ? 1 : 0);
  return 1;
}

int uniform(lua_State* state) {
  check_count(state, 0, 2, "uniform(), uniform(max) or uniform(min, max)");
  const int count = lua_gettop(state);
  const double min = count == 2 ? check_number(state, 1) : 0;
  const double max = count == 0 ? 1 : check_number(state, count);
  check_order(state, min <= max, "max is less than min");
  lua_pushnumber(state, stream_of(state).uniform(min, max));
  return 1;
}

// `max` is excluded, unless it equals `min`.
int uniform_int(lua_State* state) {
  check_count(state, 1, 2, "uniform_int(max) or uniform_int(min, max)");
  const int count = lua_gettop(state);
  const lua_Integer min = count == 2 ? check_floored(state, 1) : 0;
  const lua_Integer max = check_floored(state, count);
  check_order(state, min <= max, count == 2 ? "max is less than min" : "max is negative");
  const auto range = static_cast<lua_Unsigned>(max) - static_cast<lua_Unsigned>(min);
  // Multiply-shift: each of `range` values from 64 bits without a division or a second draw.
  const auto wide = static_cast<unsigned __int128>(stream_of(state).bits()) * range;
  const auto offset = static_cast<lua_Unsigned>(wide >> 64);
  lua_pushinteger(state, static_cast<lua_Integer>(static_cast<lua_Unsigned>(min) + offset));
  return 1;
}

int exponential(lua_State* state) {
  check_count(state, 1, 1, "exponential(mean)");
  lua_pushnumber(state, stream_of(state).exponential(check_number(state, 1)));
  return 1;
}

int gaussian(lua_State* state) {
  check_count(state, 1, 2, "gaussian(standard_deviation [, mean])");
  const double standard_deviation = check_number(state, 1);
  const double mean = lua_gettop(state) == 2 ? check_number(state, 2) : 0;
  lua_pushnumber(state, stream_of(state).gaussian(standard_deviation, mean));
  return 1;
}

int poisson(lua_State* state) {
  check_count(state, 1, 1, "poisson(mean)");
  const double mean = check_number(state, 1);
  check_order(state, mean >= 0 && mean <= RandomStream::max_poisson_mean,
              "mean is not between 0 and 1e15");
  lua_pushinteger(state, stream_of(state).poisson(mean));
  return 1;
}

}  // namespace

void push_robot_random(lua_State* state, RandomStream& stream) {
  lua_createtable(state, 0, 6);
  set_function<bernoulli>(state, "bernoulli", &stream);
  set_function<uniform>(state, "uniform", &stream);
  set_function<uniform_int>(state, "uniform_int", &stream);
  set_function<exponential>(state, "exponential", &stream);
  set_function<gaussian>(state, "gaussian", &stream);
  set_function<poisson>(state, "poisson", &stream);
}

}  // namespace ziggurat::lua
