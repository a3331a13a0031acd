// SPDX-License-Identifier: MIT
#pragma once
// Bytes in scripts: arrays of integers from 0 to 255.

#include <cstddef>
#include <cstdint>
#include <lua.hpp>
#include <optional>
#include <vector>

#include "ziggurat/radio.h"

namespace ziggurat::lua {

/// The number at `index`, truncated toward zero, then modulo 256; none if it is not a finite
/// number. Strings are not numbers.
std::optional<std::uint8_t> to_byte(lua_State* state, int index);

/// Raises a Lua error if one of the elements 1 … count of the table at `index` is not a finite
/// number. Calls no metamethods.
void check_bytes(lua_State* state, int index, std::size_t count);

/// Elements 1 … count of a table that check_bytes() has accepted. Raises no error.
std::vector<std::uint8_t> to_bytes(lua_State* state, int index, std::size_t count);

/// Pushes a new array.
void push_bytes(lua_State* state, Bytes bytes);

}  // namespace ziggurat::lua
