#pragma once
// Numbers, vectors and orientations as scripts have them: {x, y}, {x, y, z}, {angle, axis}.

#include <array>
#include <lua.hpp>

namespace ziggurat::lua {

/// Sets field `name` of the table on top.
void set_number(lua_State* state, const char* name, double number);

/// Sets x, y and z of the table on top.
void set_vector(lua_State* state, const std::array<double, 3>& vector);

/// Pushes {x, y}.
void push_vector(lua_State* state, const std::array<double, 2>& vector);

/// Pushes {x, y, z}.
void push_vector(lua_State* state, const std::array<double, 3>& vector);

struct AngleAxis {
  double angle = 0;                     ///< [0, 2 pi] [rad]
  std::array<double, 3> axis{0, 0, 1};  ///< unit
};

/// @param quaternion  unit, w, x, y, z
AngleAxis to_angle_axis(const std::array<double, 4>& quaternion);

}  // namespace ziggurat::lua
