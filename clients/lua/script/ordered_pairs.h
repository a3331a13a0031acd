// SPDX-License-Identifier: MIT
#pragma once
// pairs() in the same order in every run. Lua's own order depends on a hash with a seed from
// addresses and the time of day: a script with a loop over robot.joints would behave differently in
// each run.

#include <lua.hpp>

namespace ziggurat::lua {

/// Replaces the global `pairs`: numbers ascending, then strings by their bytes, then other keys
/// in the order of next(). May raise a Lua error.
void set_ordered_pairs(lua_State* state);

}  // namespace ziggurat::lua
