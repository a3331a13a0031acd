#include "devices/proximity.h"

#include "devices/kept.h"
#include "script/vectors.h"

namespace ziggurat::lua {
namespace {

// What is kept under its address: the array of readings, or one of the tables that hold them.
constexpr char key = 0;

/// Writes the readings into the array on top.
void fill(lua_State* state, const ScriptedRobot& robot) {
  lua_Integer position = 0;
  for (const double reading : robot.proximity) {
    ++position;
    if (robot.proximity_angles.empty()) {
      lua_pushnumber(state, reading);
      lua_rawseti(state, -2, position);
    } else {
      lua_rawgeti(state, -1, position);
      set_number(state, "value", reading);
      lua_pop(state, 1);
    }
  }
}

/// Puts a table with the sensor's angle at each place of the two arrays on top.
void add_tables(lua_State* state, const ScriptedRobot& robot) {
  lua_Integer position = 0;
  for (const double angle : robot.proximity_angles) {
    ++position;
    lua_createtable(state, 0, 2);
    set_number(state, "angle", angle);
    lua_pushvalue(state, -1);
    lua_rawseti(state, -3, position);
    lua_rawseti(state, -3, position);
  }
}

}  // namespace

bool has_proximity(const ScriptedRobot& robot) { return !robot.proximity.empty(); }

void push_proximity(lua_State* state, ScriptedRobot& robot) {
  const int size = static_cast<int>(robot.proximity.size());
  lua_createtable(state, size, 0);
  if (robot.proximity_angles.empty()) {
    lua_pushvalue(state, -1);
  } else {  // scripts may change their array, so it is another
    lua_createtable(state, size, 0);
    add_tables(state, robot);
  }
  fill(state, robot);
  keep(state, &key, robot);
}

void refresh_proximity(lua_State* state, const ScriptedRobot& robot) {
  push_kept(state, &key, robot);
  fill(state, robot);
  lua_pop(state, 1);
}

}  // namespace ziggurat::lua
