#pragma once
// Bytes as scripts have them: arrays of integers from 0 to 255.

#include <cstddef>
#include <cstdint>
#include <lua.hpp>
#include <optional>
#include <vector>

#include "script/scripted_devices.h"

namespace ziggurat::lua {

/// The number at `index`, truncated toward zero, then modulo 256; none if there is no finite
/// number. Strings are no numbers.
std::optional<std::uint8_t> to_byte(lua_State* state, int index);

/// Appends elements 1 … count of the table at `index`, without calling its metamethods. If one is
/// not a finite number, a Lua error says which, and `bytes` is as it was.
void append_bytes(lua_State* state, int index, std::size_t count, std::vector<std::uint8_t>& bytes);

/// Pushes a new array.
void push_bytes(lua_State* state, Bytes bytes);

}  // namespace ziggurat::lua
