// robot.positioning: position, orientation

#include "devices/device_table.h"
#include "script/tables.h"

namespace ziggurat::lua {
namespace {

/// Second, an array of position, orientation and its axis.
void make_positioning(lua_State* state, Robot&) {
  lua_createtable(state, 0, 2);  // robot.positioning
  lua_createtable(state, 3, 0);  // the array
  lua_createtable(state, 0, 3);  // position
  lua_pushvalue(state, -1);
  lua_rawseti(state, -3, 1);
  lua_setfield(state, -3, "position");
  lua_createtable(state, 0, 3);  // orientation
  lua_createtable(state, 0, 3);  // its axis
  lua_pushvalue(state, -1);
  lua_rawseti(state, -4, 3);
  lua_setfield(state, -2, "axis");
  lua_pushvalue(state, -1);
  lua_rawseti(state, -3, 2);
  lua_setfield(state, -3, "orientation");
}

void fill_positioning(lua_State* state, Robot& robot) {
  lua_rawgeti(state, -1, 1);
  set_vector(state, robot.positioning()->position);
  lua_pop(state, 1);
  const AngleAxis orientation = to_angle_axis(robot.positioning()->orientation);
  lua_rawgeti(state, -1, 2);
  set_number(state, "angle", orientation.angle);
  set_number(state, "yaw", robot.positioning()->yaw());
  lua_pop(state, 1);
  lua_rawgeti(state, -1, 3);
  set_vector(state, orientation.axis);
  lua_pop(state, 1);
}

}  // namespace

extern const DeviceKind positioning_kind{
    "positioning", [](Robot& robot) { return robot.positioning() != nullptr; }, make_positioning,
    fill_positioning};

}  // namespace ziggurat::lua
