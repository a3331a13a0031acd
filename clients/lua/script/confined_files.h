// SPDX-License-Identifier: MIT
#pragma once
// The functions of the libraries io and os that open, remove and rename files.

#include <cstddef>
#include <lua.hpp>

#include "script/folders.h"

namespace ziggurat::lua {

/// Limits them to the files below the folders, which outlive the state, and to so many at once. May
/// raise a Lua error.
void confine_files(lua_State* state, const Folders& folders, std::size_t most_files);

constexpr std::size_t longest_path = 4096;  // of the system [bytes]

/// Whether a script may read this file: it is below the folders, and regular or missing.
bool may_read(const Folders& folders, const char* file);

/// Pushes "'FILE' is not a file that scripts may use; …".
void push_refusal(lua_State* state, const char* file);

}  // namespace ziggurat::lua
