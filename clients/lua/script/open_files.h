// SPDX-License-Identifier: MIT
#pragma once
// The files that a script has open: their number is bounded, as all scripts of a process share what
// it may open.

#include <cstddef>
#include <lua.hpp>

namespace ziggurat::lua {

/// Number of files that a script may have open if the process may open enough.
inline constexpr std::size_t most_open_files = 32;

/// May raise a Lua error, as all functions here.
/// @param most  files that scripts of this state may have open at once
void limit_open_files(lua_State* state, std::size_t most);

/// Whether one more may be opened. Files that are not used any more are closed before it says no.
bool may_open_file(lua_State* state);

/// Counts the file at this index, if it is one, until it is closed.
void count_open_file(lua_State* state, int index);

/// Pushes "'FILE' is not opened: …".
void push_too_many_files(lua_State* state, const char* file);

}  // namespace ziggurat::lua
