// SPDX-License-Identifier: MIT
#include "script/tables.h"

#include <cmath>

#include "script/vectors.h"
#include "ziggurat/sensors.h"

namespace ziggurat::lua {

void set_number(lua_State* state, const char* name, double number) {
  lua_pushnumber(state, number);
  lua_setfield(state, -2, name);
}

void set_integer(lua_State* state, const char* name, lua_Integer number) {
  lua_pushinteger(state, number);
  lua_setfield(state, -2, name);
}

void set_vector(lua_State* state, const std::array<double, 3>& vector) {
  set_number(state, "x", vector[0]);
  set_number(state, "y", vector[1]);
  set_number(state, "z", vector[2]);
}

void push_vector(lua_State* state, const std::array<double, 2>& vector) {
  lua_createtable(state, 0, 2);
  set_number(state, "x", vector[0]);
  set_number(state, "y", vector[1]);
  set_kind(state, VectorKind::vector2);
}

void push_vector(lua_State* state, const std::array<double, 3>& vector) {
  lua_createtable(state, 0, 3);
  set_vector(state, vector);
  set_kind(state, VectorKind::vector3);
}

void set_element(lua_State* state, int table, std::string_view key) {
  lua_pushlstring(state, key.data(), key.size());
  lua_insert(state, -2);
  lua_rawset(state, table - 1);
}

void push_params(lua_State* state, const std::vector<std::pair<std::string, std::string>>& params) {
  lua_createtable(state, 0, static_cast<int>(params.size()));
  for (const auto& [name, value] : params) {
    lua_pushlstring(state, value.data(), value.size());
    set_element(state, -2, name);
  }
}

void set_orientation(lua_State* state, const std::array<double, 4>& quaternion) {
  constexpr std::array names{"w", "x", "y", "z"};
  for (std::size_t i = 0; i < names.size(); ++i) set_number(state, names[i], quaternion[i]);
  set_number(state, "yaw", yaw_of(quaternion));
  const auto [angle, axis] = to_angle_axis(quaternion);
  set_number(state, "angle", angle);
  lua_pushliteral(state, "axis");
  lua_rawget(state, -2);
  set_vector(state, axis);
  lua_pop(state, 1);
}

void push_orientation(lua_State* state, const std::array<double, 4>& quaternion) {
  lua_createtable(state, 0, 7);
  push_vector(state, std::array{0.0, 0.0, 1.0});
  lua_setfield(state, -2, "axis");
  set_orientation(state, quaternion);
  set_kind(state, VectorKind::quaternion);
}

AngleAxis to_angle_axis(const std::array<double, 4>& quaternion) {
  const auto [w, x, y, z] = quaternion;
  const double sine = std::hypot(x, y, z);  // of half the angle
  if (sine == 0) return {};
  const double last = z != 0 ? z : y != 0 ? y : x;
  const double sign = w < 0 || (w == 0 && last < 0) ? -1 : 1;  // both stand for the same rotation
  return {2 * std::atan2(sine, sign * w), {sign * x / sine, sign * y / sine, sign * z / sine}};
}

}  // namespace ziggurat::lua
