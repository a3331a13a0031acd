// SPDX-License-Identifier: MIT
// robot.magnets.<id>: set_current(current)

#include "devices/device_table.h"
#include "script/arguments.h"
#include "script/guarded.h"
#include "script/tables.h"

namespace ziggurat::lua {
namespace {

int set_current(lua_State* state) {
  check_count(state, 1, 1, "set_current(current)");
  upvalue<Magnet>(state).set_current(check_number(state, 1));
  return 0;
}

void make_magnets(lua_State* state, Robot& robot) {
  lua_createtable(state, 0, static_cast<int>(robot.magnets().size()));
  for (Magnet& magnet : robot.magnets()) {
    lua_createtable(state, 0, 1);
    set_function<set_current>(state, "set_current", &magnet);
    set_element(state, -2, magnet.id());
  }
}

}  // namespace

extern const DeviceKind magnets_kind{
    "magnets", [](Robot& robot) { return !robot.magnets().empty(); }, make_magnets, nullptr};

}  // namespace ziggurat::lua
