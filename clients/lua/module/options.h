// SPDX-License-Identifier: MIT
#pragma once
// The options of ziggurat.connect.

#include <lua.hpp>

#include "ziggurat/session.h"

namespace ziggurat::lua {

/// Checks the table at stack index 1 and the environment. Raises a Lua error for an option that
/// docs/lua-module.md does not allow.
void check_options(lua_State* state);

/// The options in a table that check_options() has accepted. Raises no error.
Options take_options(lua_State* state);

}  // namespace ziggurat::lua
