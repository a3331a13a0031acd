// SPDX-License-Identifier: MIT
#pragma once
// The table of an entity in a director's script. Its states are read when the script asks for them.

#include <lua.hpp>

#include "ziggurat/director.h"

namespace ziggurat::lua {

/// Creates the metatable of entities, which push_entity() needs. The director outlives the state.
/// May raise a Lua error.
void prepare_entities(lua_State* state, Director& director);

/// Pushes a new table. May raise a Lua error.
void push_entity(lua_State* state, const Entity& entity);

}  // namespace ziggurat::lua
