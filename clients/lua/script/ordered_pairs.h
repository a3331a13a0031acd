#pragma once
// pairs() in an order that does not change from run to run. Lua's own follows a hash that is
// seeded with addresses and the time of day: a script that loops over robot.joints by name would
// answer differently each time.

#include <lua.hpp>

namespace ziggurat::lua {

/// Replaces the global `pairs`: numbers ascending, then strings by their bytes, then other keys
/// as next() finds them. May raise a Lua error.
void set_ordered_pairs(lua_State* state);

}  // namespace ziggurat::lua
