// SPDX-License-Identifier: MIT
#pragma once
// load, loadfile, dofile and require.

#include <lua.hpp>

#include "script/folders.h"

namespace ziggurat::lua {

/// Limits them to text (precompiled chunks can crash the interpreter) and to files below the
/// folders, which outlive the state. C libraries can't be loaded. May raise a Lua error.
void confine_code(lua_State* state, const Folders& folders);

}  // namespace ziggurat::lua
