#include "devices/radios.h"

#include "devices/kept.h"
#include "script/arguments.h"
#include "script/bytes.h"
#include "script/guarded.h"

namespace ziggurat::lua {
namespace {

// What is kept under its address: the array of the radios' rx_data.
constexpr char key = 0;

/// Raises an error if a further message of `size` bytes is too much.
void check_limits(lua_State* state, const ScriptedRobot& robot, std::size_t size) {
  const RadioLimits& limits = robot.radio_limits;
  if (size > limits.message) {
    luaL_error(state, "the message has %I bytes; %I are the most that a radio sends in one",
               static_cast<LUAI_UACINT>(size), static_cast<LUAI_UACINT>(limits.message));
  }
  std::size_t bytes = size;
  std::size_t messages = 1;
  for (const Radio& radio : robot.radios) {
    bytes += radio.sent.bytes.size();
    messages += radio.sent.ends.size();
  }
  if (bytes > limits.tick) {
    luaL_error(state, "with this message the robot sends %I bytes at this tick; %I are the most",
               static_cast<LUAI_UACINT>(bytes), static_cast<LUAI_UACINT>(limits.tick));
  }
  if (messages > limits.messages) {
    luaL_error(state, "this is message %I of the robot at this tick; %I are the most",
               static_cast<LUAI_UACINT>(messages), static_cast<LUAI_UACINT>(limits.messages));
  }
}

int tx_data(lua_State* state) {
  check_count(state, 1, 1, "tx_data(table)");
  check_table(state, 1);
  const std::size_t size = lua_rawlen(state, 1);
  check_limits(state, upvalue<ScriptedRobot>(state, 1), size);
  Outgoing& sent = upvalue<Radio>(state, 2).sent;
  // Without what a message left that did not come about.
  sent.bytes.resize(sent.ends.empty() ? 0 : sent.ends.back());
  append_bytes(state, 1, size, sent.bytes);
  sent.ends.push_back(sent.bytes.size());
  return 0;
}

/// Puts the messages into the rx_data on top, each as an array of its own that the script may
/// keep.
void fill(lua_State* state, const Radio& radio) {
  lua_Integer position = 0;
  for (const Bytes message : radio.received) {
    push_bytes(state, message);
    lua_rawseti(state, -2, ++position);
  }
  for (auto left = static_cast<lua_Integer>(lua_rawlen(state, -1)); left > position; --left) {
    lua_pushnil(state);
    lua_rawseti(state, -2, left);
  }
}

}  // namespace

bool has_radios(const ScriptedRobot& robot) { return !robot.radios.empty(); }

void push_radios(lua_State* state, ScriptedRobot& robot) {
  const int count = static_cast<int>(robot.radios.size());
  lua_createtable(state, count, 0);  // the array
  lua_createtable(state, 0, count);  // robot.radios
  for (int i = 0; i < count; ++i) {
    Radio& radio = robot.radios[static_cast<std::size_t>(i)];
    lua_pushlstring(state, radio.id.data(), radio.id.size());
    lua_createtable(state, 0, 2);
    if (radio.has_transmitter) {
      lua_pushlightuserdata(state, &robot);
      lua_pushlightuserdata(state, &radio);
      lua_pushcclosure(state, guarded<tx_data>, 2);
      lua_setfield(state, -2, "tx_data");
    }
    if (radio.has_receiver) {
      lua_newtable(state);
      fill(state, radio);
      lua_pushvalue(state, -1);
      lua_rawseti(state, -6, i + 1);
      lua_setfield(state, -2, "rx_data");
    }
    lua_rawset(state, -3);
  }
  lua_insert(state, -2);
  keep(state, &key, robot);
}

void refresh_radios(lua_State* state, const ScriptedRobot& robot) {
  push_kept(state, &key, robot);
  lua_Integer i = 0;
  for (const Radio& radio : robot.radios) {
    ++i;
    if (!radio.has_receiver) continue;
    lua_rawgeti(state, -1, i);
    fill(state, radio);
    lua_pop(state, 1);
  }
  lua_pop(state, 1);
}

}  // namespace ziggurat::lua
