// SPDX-License-Identifier: MIT
// robot.joints.<id>: encoder, position, velocity, set_target(target)

#include "devices/device_table.h"
#include "script/arguments.h"
#include "script/guarded.h"
#include "script/tables.h"

namespace ziggurat::lua {
namespace {

int set_target(lua_State* state) {
  check_count(state, 1, 1, "set_target(target)");
  upvalue<Joint>(state).set_target(check_number(state, 1));
  return 0;
}

/// Second, the array of the joints' tables.
void make_joints(lua_State* state, Robot& robot) {
  const int count = static_cast<int>(robot.joints().size());
  lua_createtable(state, 0, count);
  lua_createtable(state, count, 0);
  lua_Integer position = 0;
  for (Joint& joint : robot.joints()) {
    lua_createtable(state, 0, 4);
    if (joint.has_motor()) set_function<set_target>(state, "set_target", &joint);
    lua_pushvalue(state, -1);
    lua_rawseti(state, -3, ++position);
    set_element(state, -3, joint.id());
  }
}

void fill_joints(lua_State* state, Robot& robot) {
  lua_Integer position = 0;
  for (const Joint& joint : robot.joints()) {
    ++position;
    if (!joint.has_encoder()) continue;
    lua_rawgeti(state, -1, position);
    set_number(state, "encoder", joint.encoder());
    if (joint.has_position()) set_number(state, "position", joint.position());
    if (joint.has_velocity()) set_number(state, "velocity", joint.velocity());
    lua_pop(state, 1);
  }
}

}  // namespace

extern const DeviceKind joints_kind{"joints", [](Robot& robot) { return !robot.joints().empty(); },
                                    make_joints, fill_joints};

}  // namespace ziggurat::lua
