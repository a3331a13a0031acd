#include "devices/positioning.h"

#include "devices/kept.h"
#include "script/vectors.h"

namespace ziggurat::lua {
namespace {

// What is kept under its address: an array of position, orientation and its axis.
constexpr char key = 0;

/// Writes the three tables of the array on top.
void fill(lua_State* state, const Positioning& positioning) {
  lua_rawgeti(state, -1, 1);
  set_vector(state, positioning.position);
  lua_pop(state, 1);
  const AngleAxis orientation = to_angle_axis(positioning.orientation);
  lua_rawgeti(state, -1, 2);
  set_number(state, "angle", orientation.angle);
  lua_pop(state, 1);
  lua_rawgeti(state, -1, 3);
  set_vector(state, orientation.axis);
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
  keep(state, &key, robot);
}

void refresh_positioning(lua_State* state, const ScriptedRobot& robot) {
  push_kept(state, &key, robot);
  fill(state, *robot.positioning);
  lua_pop(state, 1);
}

}  // namespace ziggurat::lua
