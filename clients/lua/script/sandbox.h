// SPDX-License-Identifier: MIT
#pragma once
// Sandbox of a script that is not trusted. It starts no program, loads no byte code and no C
// library, and uses only files below some folders (docs/lua-api.md has the whole list).

#include <cstddef>
#include <lua.hpp>

#include "script/folders.h"

namespace ziggurat::lua {

/// Replaces what would reach further, in a state whose libraries are open. May raise a Lua error.
/// @param folders  outlive the state; @param most_files  that it may have open at once
void confine(lua_State* state, const Folders& folders, std::size_t most_files);

}  // namespace ziggurat::lua
