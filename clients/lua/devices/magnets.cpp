#include "devices/magnets.h"

#include "script/arguments.h"
#include "script/guarded.h"

namespace ziggurat::lua {
namespace {

int set_current(lua_State* state) {
  check_count(state, 1, 1, "set_current(current)");
  upvalue<Magnet>(state).current.set(check_number(state, 1));
  return 0;
}

}  // namespace

bool has_magnets(const ScriptedRobot& robot) { return !robot.magnets.empty(); }

void push_magnets(lua_State* state, ScriptedRobot& robot) {
  lua_createtable(state, 0, static_cast<int>(robot.magnets.size()));
  for (Magnet& magnet : robot.magnets) {
    lua_pushlstring(state, magnet.id.data(), magnet.id.size());
    lua_createtable(state, 0, 1);
    set_function<set_current>(state, "set_current", &magnet);
    lua_rawset(state, -3);
  }
}

}  // namespace ziggurat::lua
