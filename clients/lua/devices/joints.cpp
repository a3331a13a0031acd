#include "devices/joints.h"

#include "devices/kept.h"
#include "script/arguments.h"
#include "script/guarded.h"

namespace ziggurat::lua {
namespace {

// What is kept under its address: the array of the joints' tables.
constexpr char key = 0;

int set_target(lua_State* state) {
  check_count(state, 1, 1, "set_target(target)");
  auto& joint = upvalue<Joint>(state);
  joint.target = check_number(state, 1);
  joint.is_target_fresh = true;
  return 0;
}

}  // namespace

bool has_joints(const ScriptedRobot& robot) { return !robot.joints.empty(); }

void push_joints(lua_State* state, ScriptedRobot& robot) {
  const int count = static_cast<int>(robot.joints.size());
  lua_createtable(state, count, 0);  // the array
  lua_createtable(state, 0, count);  // robot.joints
  for (int i = 0; i < count; ++i) {
    Joint& joint = robot.joints[static_cast<std::size_t>(i)];
    lua_createtable(state, 0, 2);
    if (joint.has_motor) set_function<set_target>(state, "set_target", &joint);
    if (joint.has_encoder) {
      lua_pushnumber(state, joint.encoder);
      lua_setfield(state, -2, "encoder");
    }
    lua_pushvalue(state, -1);
    lua_rawseti(state, -4, i + 1);
    lua_pushlstring(state, joint.id.data(), joint.id.size());
    lua_insert(state, -2);
    lua_rawset(state, -3);
  }
  lua_insert(state, -2);
  keep(state, &key, robot);
}

void refresh_joints(lua_State* state, const ScriptedRobot& robot) {
  push_kept(state, &key, robot);
  lua_Integer i = 0;
  for (const Joint& joint : robot.joints) {
    ++i;
    if (!joint.has_encoder) continue;
    lua_rawgeti(state, -1, i);
    lua_pushnumber(state, joint.encoder);
    lua_setfield(state, -2, "encoder");
    lua_pop(state, 1);
  }
  lua_pop(state, 1);
}

}  // namespace ziggurat::lua
