// SPDX-License-Identifier: MIT
// require "ziggurat": sessions for programs with their own Lua 5.3. docs/lua-module.md lists the
// functions; robots are the same tables as `robot` in scripts of ziggurat-lua.

#include <lua.hpp>
#include <memory>
#include <vector>

#include "module/options.h"
#include "script/arguments.h"
#include "script/environment.h"
#include "script/guarded.h"
#include "script/log_functions.h"
#include "script/robot_table.h"
#include "script/tables.h"
#include "ziggurat/session.h"

namespace ziggurat::lua {
namespace {

struct Seat {
  ziggurat::Robot* robot = nullptr;
  LogLines log;
};

/// A session and its robots as Lua sees them; neither moves, because closures point to them.
struct Connected {
  std::unique_ptr<ziggurat::Session> session;
  std::vector<std::unique_ptr<Seat>> seats;
};

/// All sessions of a Lua state. They live as long as the state, because scripts may keep their
/// functions. Created when the module is loaded, so that it is collected after everything that uses
/// it.
using Sessions = std::vector<std::unique_ptr<Connected>>;

/// The interpreter's handler of Ctrl-C sets a hook, which runs when we return: a new hook ends the
/// wait.
std::function<bool()> interruption(lua_State* state) {
  lua_rawgeti(state, LUA_REGISTRYINDEX, LUA_RIDX_MAINTHREAD);
  lua_State* const main = lua_tothread(state, -1);
  lua_pop(state, 1);
  return [main, before = lua_gethook(main)] { return lua_gethook(main) != before; };
}

void move_logs(Connected& connected) {
  for (const auto& seat : connected.seats) {
    if (move_log(seat->log, *seat->robot)) continue;
    throw std::length_error("more log lines at one tick than a message can hold");
  }
}

const char* name_of(Event event) {
  switch (event) {
    case Event::init:
      return "init";
    case Event::step:
      return "step";
    case Event::reset:
      return "reset";
    case Event::restored:
      return "restored";
  }
  return "step";
}

const char* name_of(Ending::Reason reason) {
  switch (reason) {
    case Ending::Reason::finished:
      return "finished";
    case Ending::Reason::interrupted:
      return "interrupted";
    case Ending::Reason::failed:
      return "failed";
  }
  return "failed";
}

/// Answers the tick and waits for the next. Returns its number and event, or nothing after the
/// last.
int next(lua_State* state) {
  auto& connected = upvalue<Connected>(state);
  move_logs(connected);
  if (!connected.session->next()) return 0;
  for (const auto& seat : connected.seats) refresh_robot(state, *seat->robot);
  lua_pushinteger(state, static_cast<lua_Integer>(connected.session->tick()));
  lua_pushstring(state, name_of(connected.session->event()));
  return 2;
}

/// A list of the robots that were spawned since the last call: id, controller and tick of each.
int spawned(lua_State* state) {
  const auto robots = upvalue<Connected>(state).session->take_spawned();
  lua_createtable(state, static_cast<int>(robots.size()), 0);
  lua_Integer place = 0;
  for (const SpawnedRobot& robot : robots) {
    lua_createtable(state, 0, 3);
    lua_pushlstring(state, robot.id.data(), robot.id.size());
    lua_setfield(state, -2, "id");
    lua_pushlstring(state, robot.controller.data(), robot.controller.size());
    lua_setfield(state, -2, "controller");
    lua_pushinteger(state, static_cast<lua_Integer>(robot.tick));
    lua_setfield(state, -2, "tick");
    lua_rawseti(state, -2, ++place);
  }
  return 1;
}

/// Whether the server has taken the robot out of the run.
int gone(lua_State* state) {
  lua_pushboolean(state, upvalue<Seat>(state).robot->gone());
  return 1;
}

/// Reason, message and tick of the end of the run; nothing before it.
int ending(lua_State* state) {
  const auto& ending = upvalue<Connected>(state).session->ending();
  if (!ending) return 0;
  lua_pushstring(state, name_of(ending->reason));
  lua_pushlstring(state, ending->message.data(), ending->message.size());
  lua_pushinteger(state, static_cast<lua_Integer>(ending->tick));
  return 3;
}

/// Leaves the run: as done, or as failed with a message.
int close(lua_State* state) {
  auto& connected = upvalue<Connected>(state);
  const int last = lua_gettop(state);  // session.close(m) and session:close(m) alike
  const bool has_message = last > 0 && lua_type(state, last) == LUA_TSTRING;
  move_logs(connected);
  if (has_message) {
    connected.session->leave_failed(check_text(state, last));
  } else {
    connected.session->leave();
  }
  return 0;
}

/// The robot leaves the run forever.
int fail(lua_State* state) {
  check_count(state, 1, 1, "fail(message)");
  upvalue<Seat>(state).robot->fail(check_text(state, 1));
  return 0;
}

void push_robots(lua_State* state, Connected& connected) {
  lua_createtable(state, static_cast<int>(connected.seats.size()), 0);
  lua_Integer place = 0;
  for (const auto& seat : connected.seats) {
    push_robot(state, *seat->robot);
    set_log_functions(state, seat->log);
    set_function<fail>(state, "fail", seat.get());
    set_function<gone>(state, "gone", seat.get());
    lua_pushvalue(state, -1);
    lua_rawseti(state, -3, ++place);
    set_element(state, -2, seat->robot->id());
  }
}

void push_session(lua_State* state, Connected& connected) {
  lua_newtable(state);
  set_function<next>(state, "next", &connected);
  set_function<ending>(state, "ending", &connected);
  set_function<spawned>(state, "spawned", &connected);
  set_function<close>(state, "close", &connected);
  lua_pushnumber(state, std::chrono::duration<double>(connected.session->tick_length()).count());
  lua_setfield(state, -2, "tick_length");
  lua_pushinteger(state, static_cast<lua_Integer>(connected.session->seed()));
  lua_setfield(state, -2, "seed");
  push_robots(state, connected);
  lua_setfield(state, -2, "robots");
}

Connected& open_session(lua_State* state, Sessions& sessions) {
  Options options = take_options(state);
  options.is_interrupted = interruption(state);
  auto connected = std::make_unique<Connected>();
  connected->session = std::make_unique<ziggurat::Session>(options);
  for (ziggurat::Robot& robot : connected->session->robots()) {
    connected->seats.push_back(std::make_unique<Seat>());
    connected->seats.back()->robot = &robot;
  }
  sessions.push_back(std::move(connected));
  return *sessions.back();
}

int connect(lua_State* state) {
  check_options(state);
  push_session(state, open_session(state, upvalue<Sessions>(state)));
  return 1;
}

int end_sessions(lua_State* state) {
  static_cast<Sessions*>(lua_touserdata(state, 1))->~Sessions();
  return 0;
}

}  // namespace
}  // namespace ziggurat::lua

extern "C" __attribute__((visibility("default"))) int luaopen_ziggurat(lua_State* state) {
  using namespace ziggurat::lua;
  luaL_checkversion(state);
  lua_newtable(state);
  void* const memory = lua_newuserdata(state, sizeof(Sessions));
  auto* const sessions = new (memory) Sessions();
  lua_createtable(state, 0, 1);
  lua_pushcfunction(state, guarded<end_sessions>);
  lua_setfield(state, -2, "__gc");
  lua_setmetatable(state, -2);
  lua_rawsetp(state, LUA_REGISTRYINDEX, sessions);
  set_function<connect>(state, "connect", sessions);
  return 1;
}
