// SPDX-License-Identifier: MIT
// robot.positioning: position, orientation

#include "devices/device_table.h"
#include "script/tables.h"

namespace ziggurat::lua {
namespace {

/// Second, an array of position and orientation.
void make_positioning(lua_State* state, Robot& robot) {
  lua_createtable(state, 0, 2);  // robot.positioning
  lua_createtable(state, 2, 0);  // the array
  push_vector(state, robot.positioning()->position);
  lua_pushvalue(state, -1);
  lua_rawseti(state, -3, 1);
  lua_setfield(state, -3, "position");
  push_orientation(state, robot.positioning()->orientation);
  lua_pushvalue(state, -1);
  lua_rawseti(state, -3, 2);
  lua_setfield(state, -3, "orientation");
}

void fill_positioning(lua_State* state, Robot& robot) {
  lua_rawgeti(state, -1, 1);
  set_vector(state, robot.positioning()->position);
  lua_pop(state, 1);
  lua_rawgeti(state, -1, 2);
  set_orientation(state, robot.positioning()->orientation);
  lua_pop(state, 1);
}

}  // namespace

extern const DeviceKind positioning_kind{
    "positioning", [](Robot& robot) { return robot.positioning() != nullptr; }, make_positioning,
    fill_positioning};

}  // namespace ziggurat::lua
