// SPDX-License-Identifier: MIT
#pragma once
// Values in tables of scripts: numbers, arrays, {x, y}, {x, y, z}, {angle, axis}.

#include <array>
#include <lua.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ziggurat::lua {

constexpr double centimetres = 100;  // in a metre

/// Sets field `name` of the table on top.
void set_number(lua_State* state, const char* name, double number);
void set_integer(lua_State* state, const char* name, lua_Integer number);

/// Sets x, y and z of the table on top.
void set_vector(lua_State* state, const std::array<double, 3>& vector);

/// Pushes {x, y}.
void push_vector(lua_State* state, const std::array<double, 2>& vector);

/// Pushes {x, y, z}.
void push_vector(lua_State* state, const std::array<double, 3>& vector);

/// Sets element `key` (any bytes) of a table to the value on top, and pops it.
/// @param table  negative stack index of the table
void set_element(lua_State* state, int table, std::string_view key);

/// Replaces the elements of the array on top: push(state, value) pushes the element for a value.
/// The script may keep the former elements.
template <typename Values, typename Push>
void set_elements(lua_State* state, const Values& values, Push push) {
  lua_Integer position = 0;
  for (const auto& value : values) {
    push(state, value);
    lua_rawseti(state, -2, ++position);
  }
  for (auto left = static_cast<lua_Integer>(lua_rawlen(state, -1)); left > position; --left) {
    lua_pushnil(state);
    lua_rawseti(state, -2, left);
  }
}

/// Pushes a table with these values, all strings.
void push_params(lua_State* state, const std::vector<std::pair<std::string, std::string>>& params);

struct AngleAxis {
  double angle = 0;                     ///< [0, pi] [rad]
  std::array<double, 3> axis{0, 0, 1};  ///< unit
};

/// Sets the numbers of a table from push_orientation(), which is on top, and of its axis.
/// @param quaternion  unit, w, x, y, z
void set_orientation(lua_State* state, const std::array<double, 4>& quaternion);

/// Pushes {w, x, y, z, angle, axis = {x, y, z}, yaw}.
/// @param quaternion  unit, w, x, y, z
void push_orientation(lua_State* state, const std::array<double, 4>& quaternion);

/// @param quaternion  unit, w, x, y, z
AngleAxis to_angle_axis(const std::array<double, 4>& quaternion);

}  // namespace ziggurat::lua
