// SPDX-License-Identifier: MIT
#include "script/math_random.h"

#include <bit>

#include "script/arguments.h"
#include "script/guarded.h"

namespace ziggurat::lua {
namespace {

// A fraction is cut off, as scripts for Lua 5.2 expect.
lua_Integer check_bound(lua_State* state, int index) {
  return lua_type(state, index) == LUA_TNUMBER ? check_floored(state, index)
                                               : luaL_checkinteger(state, index);
}

// As in the Lua manual: a float in [0, 1); an integer in [1, m]; an integer in [m, n].
int random(lua_State* state) {
  check_count(state, 0, 2, "random(), random(m) or random(m, n)");
  auto& stream = upvalue<RandomStream>(state);
  const int count = lua_gettop(state);
  if (count == 0) {
    lua_pushnumber(state, stream.unit());
    return 1;
  }
  const lua_Integer low = count == 2 ? check_bound(state, 1) : 1;
  const lua_Integer high = check_bound(state, count);
  luaL_argcheck(state, low <= high, count, "interval is empty");
  const auto last = static_cast<lua_Unsigned>(high) - static_cast<lua_Unsigned>(low);
  const auto bits = stream.bits();
  const auto offset = static_cast<lua_Unsigned>(
      (static_cast<unsigned __int128>(bits) * (static_cast<unsigned __int128>(last) + 1)) >> 64);
  lua_pushinteger(state, static_cast<lua_Integer>(static_cast<lua_Unsigned>(low) + offset));
  return 1;
}

int randomseed(lua_State* state) {
  const auto seed = std::bit_cast<std::uint64_t>(luaL_checknumber(state, 1));
  upvalue<RandomStream>(state) = RandomStream(seed, "math.randomseed");
  return 0;
}

}  // namespace

void set_math_random(lua_State* state, RandomStream& stream) {
  lua_getglobal(state, LUA_MATHLIBNAME);
  set_function<random>(state, "random", &stream);
  set_function<randomseed>(state, "randomseed", &stream);
  lua_pop(state, 1);
}

}  // namespace ziggurat::lua
