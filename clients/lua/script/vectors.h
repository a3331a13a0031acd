// SPDX-License-Identifier: MIT
#pragma once
// vector2, vector3 and quaternion of the dialect: tables {x, y}, {x, y, z}, {w, x, y, z} with
// operators and methods.

#include <lua.hpp>

namespace ziggurat::lua {

/// Sets the globals vector2, vector3 and quaternion, which make them.
void set_vectors(lua_State* state);

enum class VectorKind { vector2, vector3, quaternion };

/// Gives the table on top the operators and methods of its kind; nothing in a state without
/// set_vectors().
void set_kind(lua_State* state, VectorKind kind);

}  // namespace ziggurat::lua
