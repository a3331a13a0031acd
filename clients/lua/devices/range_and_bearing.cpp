#include "devices/range_and_bearing.h"

#include <algorithm>

#include "devices/kept.h"
#include "script/arguments.h"
#include "script/bytes.h"
#include "script/guarded.h"

namespace ziggurat::lua {
namespace {

// What is kept under its address: the table.
constexpr char key = 0;

constexpr double centimetres = 100;  // in a metre

using Data = Setting<std::vector<std::uint8_t>>;

int set_byte(lua_State* state, Data& data) {
  const std::size_t position = check_position(state, 1, data.value.size(), "bytes of data");
  data.value[position] = check_byte(state, 2);
  data.is_fresh = true;
  return 0;
}

int set_data(lua_State* state) {
  check_count(state, 1, 2, "set_data(table) or set_data(index, byte)");
  Data& data = upvalue<Data>(state);
  if (lua_gettop(state) == 2) return set_byte(state, data);
  check_table(state, 1);
  const std::size_t size = data.value.size();
  if (lua_rawlen(state, 1) != size) {
    luaL_argerror(state, 1,
                  lua_pushfstring(state, "%I numbers; this robot sends packets of %I bytes",
                                  static_cast<LUAI_UACINT>(lua_rawlen(state, 1)),
                                  static_cast<LUAI_UACINT>(size)));
  }
  append_bytes(state, 1, size, data.value);
  data.value.erase(data.value.begin(), data.value.begin() + static_cast<std::ptrdiff_t>(size));
  data.is_fresh = true;
  return 0;
}

int clear_data(lua_State* state) {
  check_count(state, 0, 0, "clear_data()");
  Data& data = upvalue<Data>(state);
  std::fill(data.value.begin(), data.value.end(), std::uint8_t{0});
  data.is_fresh = true;
  return 0;
}

void push_packet(lua_State* state, const Packet& packet) {
  lua_createtable(state, 0, 4);
  lua_pushnumber(state, packet.range * centimetres);
  lua_setfield(state, -2, "range");
  lua_pushnumber(state, packet.horizontal_bearing);
  lua_setfield(state, -2, "horizontal_bearing");
  lua_pushnumber(state, packet.vertical_bearing);
  lua_setfield(state, -2, "vertical_bearing");
  push_bytes(state, packet.data);
  lua_setfield(state, -2, "data");
}

/// Puts the packets into the table on top, each as a table of its own that the script may keep.
void fill(lua_State* state, const RangeAndBearing& from) {
  lua_Integer position = 0;
  for (const Packet& packet : from.packets) {
    push_packet(state, packet);
    lua_rawseti(state, -2, ++position);
  }
  for (auto left = static_cast<lua_Integer>(lua_rawlen(state, -1)); left > position; --left) {
    lua_pushnil(state);
    lua_rawseti(state, -2, left);
  }
}

}  // namespace

bool has_range_and_bearing(const ScriptedRobot& robot) {
  return robot.range_and_bearing.has_value();
}

void push_range_and_bearing(lua_State* state, ScriptedRobot& robot) {
  RangeAndBearing& from = *robot.range_and_bearing;
  lua_createtable(state, 0, 2);
  if (from.has_transmitter) {
    set_function<set_data>(state, "set_data", &from.data);
    set_function<clear_data>(state, "clear_data", &from.data);
  }
  if (from.has_receiver) fill(state, from);
  lua_pushvalue(state, -1);
  keep(state, &key, robot);
}

void refresh_range_and_bearing(lua_State* state, const ScriptedRobot& robot) {
  if (!robot.range_and_bearing->has_receiver) return;
  push_kept(state, &key, robot);
  fill(state, *robot.range_and_bearing);
  lua_pop(state, 1);
}

}  // namespace ziggurat::lua
