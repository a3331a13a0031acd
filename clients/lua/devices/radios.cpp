// SPDX-License-Identifier: MIT
// robot.radios.<id>: tx_data(bytes), rx_data

#include "devices/device_table.h"
#include "script/arguments.h"
#include "script/bytes.h"
#include "script/guarded.h"
#include "script/tables.h"

namespace ziggurat::lua {
namespace {

int tx_data(lua_State* state) {
  check_count(state, 1, 1, "tx_data(table)");
  check_table(state, 1);
  const std::size_t size = lua_rawlen(state, 1);
  if (size > Radio::max_message_bytes) {
    luaL_error(state, "a message of %I bytes; at most %I are allowed",
               static_cast<LUAI_UACINT>(size), static_cast<LUAI_UACINT>(Radio::max_message_bytes));
  }
  check_bytes(state, 1, size);
  upvalue<Radio>(state).send(to_bytes(state, 1, size));
  return 0;
}

/// Second, an array of the radios' rx_data.
void make_radios(lua_State* state, Robot& robot) {
  const int count = static_cast<int>(robot.radios().size());
  lua_createtable(state, 0, count);
  lua_createtable(state, count, 0);
  lua_Integer position = 0;
  for (Radio& radio : robot.radios()) {
    ++position;
    lua_createtable(state, 0, 2);
    if (radio.sends()) set_function<tx_data>(state, "tx_data", &radio);
    if (radio.receives()) {
      lua_newtable(state);
      lua_pushvalue(state, -1);
      lua_rawseti(state, -4, position);
      lua_setfield(state, -2, "rx_data");
    }
    set_element(state, -3, radio.id());
  }
}

void fill_radios(lua_State* state, Robot& robot) {
  lua_Integer position = 0;
  for (const Radio& radio : robot.radios()) {
    ++position;
    if (!radio.receives()) continue;
    lua_rawgeti(state, -1, position);
    set_elements(state, radio.received(), push_bytes);
    lua_pop(state, 1);
  }
}

}  // namespace

extern const DeviceKind radios_kind{"radios", [](Robot& robot) { return !robot.radios().empty(); },
                                    make_radios, fill_radios};

}  // namespace ziggurat::lua
