#include "devices/positioning.h"

#include <cmath>

namespace ziggurat::lua {
namespace {

// Its address is where the registry keeps an array of position, orientation and its axis.
constexpr char key = 0;

void set_number(lua_State* state, const char* name, double number) {
  lua_pushnumber(state, number);
  lua_setfield(state, -2, name);
}

void set_vector(lua_State* state, double x, double y, double z) {
  set_number(state, "x", x);
  set_number(state, "y", y);
  set_number(state, "z", z);
}

/// Writes the three tables of the array on top.
void fill(lua_State* state, const Positioning& positioning) {
  const auto& position = positioning.position;
  lua_rawgeti(state, -1, 1);
  set_vector(state, position[0], position[1], position[2]);
  lua_pop(state, 1);
  const auto [w, x, y, z] = positioning.orientation;
  const double sine = std::hypot(x, y, z);  // of half the angle
  lua_rawgeti(state, -1, 2);
  set_number(state, "angle", sine == 0 ? 0 : 2 * std::atan2(sine, w));
  lua_pop(state, 1);
  lua_rawgeti(state, -1, 3);
  if (sine == 0) {
    set_vector(state, 0, 0, 1);
  } else {
    set_vector(state, x / sine, y / sine, z / sine);
  }
  lua_pop(state, 1);
}

}  // namespace

bool has_positioning(const ScriptedRobot& robot) { return robot.positioning.has_value(); }

void push_positioning(lua_State* state, ScriptedRobot& robot) {
  lua_createtable(state, 0, 2);  // robot.positioning
  lua_createtable(state, 3, 0);  // the array
  lua_createtable(state, 0, 3);  // position
  lua_pushvalue(state, -1);
  lua_rawseti(state, -3, 1);
  lua_setfield(state, -3, "position");
  lua_createtable(state, 0, 2);  // orientation
  lua_createtable(state, 0, 3);  // its axis
  lua_pushvalue(state, -1);
  lua_rawseti(state, -4, 3);
  lua_setfield(state, -2, "axis");
  lua_pushvalue(state, -1);
  lua_rawseti(state, -3, 2);
  lua_setfield(state, -3, "orientation");
  fill(state, *robot.positioning);
  lua_rawsetp(state, LUA_REGISTRYINDEX, &key);
}

void refresh_positioning(lua_State* state, const ScriptedRobot& robot) {
  lua_rawgetp(state, LUA_REGISTRYINDEX, &key);
  fill(state, *robot.positioning);
  lua_pop(state, 1);
}

}  // namespace ziggurat::lua
