#include "devices/kept.h"

namespace ziggurat::lua {

// The registry has a table for each robot, under the robot's address: a state may have several.
void keep(lua_State* state, const char* key, const ScriptedRobot& robot) {
  if (lua_rawgetp(state, LUA_REGISTRYINDEX, &robot) == LUA_TNIL) {
    lua_pop(state, 1);
    lua_newtable(state);
    lua_pushvalue(state, -1);
    lua_rawsetp(state, LUA_REGISTRYINDEX, &robot);
  }
  lua_insert(state, -2);
  lua_rawsetp(state, -2, key);
  lua_pop(state, 1);
}

void push_kept(lua_State* state, const char* key, const ScriptedRobot& robot) {
  lua_rawgetp(state, LUA_REGISTRYINDEX, &robot);
  lua_rawgetp(state, -1, key);
  lua_remove(state, -2);
}

}  // namespace ziggurat::lua
