// SPDX-License-Identifier: MIT
#include "module/options.h"

#include <cmath>
#include <cstdlib>
#include <cstring>

namespace ziggurat::lua {
namespace {

constexpr const char* known[] = {"endpoint", "controller",      "robots",       "name",
                                 "version",  "connect_timeout", "wait_timeout", "resume_timeout"};

bool is_known(const char* name) {
  for (const char* const one : known) {
    if (std::strcmp(one, name) == 0) return true;
  }
  return false;
}

bool is_duration(lua_State* state) {
  const double seconds = lua_tonumber(state, -1);
  return lua_type(state, -1) == LUA_TNUMBER && seconds >= 0 && seconds <= 1e6;
}

void check_robots(lua_State* state) {
  if (lua_type(state, -1) == LUA_TSTRING) return;
  if (!lua_istable(state, -1))
    luaL_error(state, "connect: robots must be a string or an array of strings");
  const auto count = static_cast<lua_Integer>(lua_rawlen(state, -1));
  for (lua_Integer i = 1; i <= count; ++i) {
    if (lua_rawgeti(state, -1, i) != LUA_TSTRING) {
      luaL_error(state, "connect: robots[%I] must be a string", static_cast<LUAI_UACINT>(i));
    }
    lua_pop(state, 1);
  }
}

void check_option(lua_State* state, const char* name) {
  if (std::strcmp(name, "robots") == 0) return check_robots(state);
  if (std::strstr(name, "timeout") != nullptr) {
    if (!is_duration(state))
      luaL_error(state, "connect: %s must be a number of seconds from 0 to 1e6", name);
  } else if (lua_type(state, -1) != LUA_TSTRING) {
    luaL_error(state, "connect: %s must be a string", name);
  }
}

std::string text_of(lua_State* state, const char* name) {
  lua_pushstring(state, name);
  lua_rawget(state, 1);
  std::size_t size = 0;
  const char* const bytes = lua_tolstring(state, -1, &size);
  std::string text = bytes == nullptr ? std::string() : std::string(bytes, size);
  lua_pop(state, 1);
  return text;
}

std::optional<std::chrono::milliseconds> duration_of(lua_State* state, const char* name) {
  lua_pushstring(state, name);
  std::optional<std::chrono::milliseconds> duration;
  if (lua_rawget(state, 1) == LUA_TNUMBER) {
    duration = std::chrono::milliseconds(std::llround(1000 * lua_tonumber(state, -1)));
  }
  lua_pop(state, 1);
  return duration;
}

std::vector<std::string> robots_of(lua_State* state) {
  std::vector<std::string> robots;
  lua_pushstring(state, "robots");
  if (lua_rawget(state, 1) == LUA_TSTRING) robots.emplace_back(lua_tostring(state, -1));
  const std::size_t count = lua_istable(state, -1) ? lua_rawlen(state, -1) : 0;
  for (std::size_t i = 1; i <= count; ++i) {
    lua_rawgeti(state, -1, static_cast<lua_Integer>(i));
    robots.emplace_back(lua_tostring(state, -1));
    lua_pop(state, 1);
  }
  lua_pop(state, 1);
  return robots;
}

}  // namespace

void check_options(lua_State* state) {
  if (lua_isnoneornil(state, 1)) {
    lua_settop(state, 0);
    lua_newtable(state);
  }
  luaL_checktype(state, 1, LUA_TTABLE);
  lua_settop(state, 1);
  for (lua_pushnil(state); lua_next(state, 1) != 0; lua_pop(state, 1)) {
    if (lua_type(state, -2) != LUA_TSTRING) luaL_error(state, "connect: options must have names");
    const char* const name = lua_tostring(state, -2);
    if (!is_known(name)) luaL_error(state, "connect: unknown option '%s'", name);
    check_option(state, name);
  }
}

Options take_options(lua_State* state) {
  Options options;
  options.endpoint = text_of(state, "endpoint");
  options.read_environment();
  options.controller = text_of(state, "controller");
  const char* const controller = std::getenv("ZIGGURAT_CONTROLLER");
  if (options.controller.empty() && controller != nullptr) options.controller = controller;
  options.robots = robots_of(state);
  options.name = text_of(state, "name");
  if (options.name.empty()) options.name = "lua";
  options.version = text_of(state, "version");
  if (const auto duration = duration_of(state, "connect_timeout")) {
    options.connect_timeout = *duration;
  }
  options.wait_timeout = duration_of(state, "wait_timeout");
  options.resume_timeout = duration_of(state, "resume_timeout");
  return options;
}

}  // namespace ziggurat::lua
