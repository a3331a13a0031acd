#include "devices/proximity.h"

#include "devices/kept.h"

namespace ziggurat::lua {
namespace {

// What is kept under its address: the table.
constexpr char key = 0;

void fill(lua_State* state, const ScriptedRobot& robot) {
  lua_Integer position = 0;
  for (const double reading : robot.proximity) {
    lua_pushnumber(state, reading);
    lua_rawseti(state, -2, ++position);
  }
}

}  // namespace

bool has_proximity(const ScriptedRobot& robot) { return !robot.proximity.empty(); }

void push_proximity(lua_State* state, ScriptedRobot& robot) {
  lua_createtable(state, static_cast<int>(robot.proximity.size()), 0);
  fill(state, robot);
  lua_pushvalue(state, -1);
  keep(state, &key, robot);
}

void refresh_proximity(lua_State* state, const ScriptedRobot& robot) {
  push_kept(state, &key, robot);
  fill(state, robot);
  lua_pop(state, 1);
}

}  // namespace ziggurat::lua
