// SPDX-License-Identifier: MIT
// robot.range_and_bearing: [i], set_data(…), clear_data()

#include "devices/device_table.h"
#include "script/arguments.h"
#include "script/bytes.h"
#include "script/guarded.h"
#include "script/tables.h"

namespace ziggurat::lua {
namespace {

int set_byte(lua_State* state, RangeAndBearing& device) {
  const std::size_t position = check_position(state, 1, device.data_size(), "bytes of data");
  const std::uint8_t byte = check_byte(state, 2);
  std::vector<std::uint8_t> data(device.data().begin(), device.data().end());
  data[position] = byte;
  device.set_data(data);
  return 0;
}

int set_data(lua_State* state) {
  check_count(state, 1, 2, "set_data(table) or set_data(index, byte)");
  auto& device = upvalue<RangeAndBearing>(state);
  if (lua_gettop(state) == 2) return set_byte(state, device);
  check_table(state, 1);
  const std::size_t size = lua_rawlen(state, 1);
  if (size != device.data_size()) {
    luaL_argerror(state, 1,
                  lua_pushfstring(state, "%I numbers; this robot sends packets of %I bytes",
                                  static_cast<LUAI_UACINT>(size),
                                  static_cast<LUAI_UACINT>(device.data_size())));
  }
  check_bytes(state, 1, size);
  device.set_data(to_bytes(state, 1, size));
  return 0;
}

int clear_data(lua_State* state) {
  check_count(state, 0, 0, "clear_data()");
  upvalue<RangeAndBearing>(state).clear_data();
  return 0;
}

void push_packet(lua_State* state, const RangeAndBearing::Packet& packet) {
  lua_createtable(state, 0, 4);
  set_number(state, "range", packet.range * centimetres);
  set_number(state, "horizontal_bearing", packet.horizontal_bearing);
  set_number(state, "vertical_bearing", packet.vertical_bearing);
  push_bytes(state, packet.data);
  lua_setfield(state, -2, "data");
}

void make_range_and_bearing(lua_State* state, Robot& robot) {
  lua_createtable(state, 0, 2);
  if (!robot.range_and_bearing()->sends()) return;
  set_function<set_data>(state, "set_data", robot.range_and_bearing());
  set_function<clear_data>(state, "clear_data", robot.range_and_bearing());
}

void fill_range_and_bearing(lua_State* state, Robot& robot) {
  if (!robot.range_and_bearing()->receives()) return;
  set_elements(state, robot.range_and_bearing()->packets(), push_packet);
}

}  // namespace

extern const DeviceKind range_and_bearing_kind{
    "range_and_bearing", [](Robot& robot) { return robot.range_and_bearing() != nullptr; },
    make_range_and_bearing, fill_range_and_bearing};

}  // namespace ziggurat::lua
