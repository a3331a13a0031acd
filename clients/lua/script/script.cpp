// SPDX-License-Identifier: MIT
#include "script/script.h"

#include <string_view>
#include <system_error>
#include <utility>

#include "script/error_message.h"
#include "script/guarded.h"
#include "script/missing_fields.h"
#include "script/stuck_call.h"

namespace ziggurat::lua {
namespace {

namespace fs = std::filesystem;

// Growth of a state between two collections, in per cent: less while it is made, so that it takes
// no memory that it never needs again; then that of Lua.
constexpr int pause_of_build = 115, pause_of_scripts = 200;

constexpr int handler = 1;  // stack index of keep_traceback during every call

// In messages the path is relative to the working directory if the script is below it: Lua shortens
// paths of more than 60 bytes.
fs::path shown(const fs::path& script) {
  std::error_code error;
  const fs::path here = fs::current_path(error);
  if (error) return script;
  const fs::path relative = (here / script).lexically_normal().lexically_proximate(here);
  return relative.empty() || *relative.begin() == ".." ? script : relative;
}

/// Whether the value on top is a function, or may have a metatable that makes it one.
bool may_be_called(lua_State* state) {
  const int type = lua_type(state, -1);
  return type == LUA_TFUNCTION || type == LUA_TTABLE || type == LUA_TUSERDATA;
}

int get_global(lua_State* state) {
  lua_getglobal(state, lua_tostring(state, 1));
  return 1;
}

// A metatable of _G may raise an error for an unknown global: then there is none.
void get_global_if_any(lua_State* state, const char* name) {
  lua_pushcfunction(state, get_global);
  lua_pushstring(state, name);
  if (lua_pcall(state, 1, 1, 0) == LUA_OK) return;
  lua_pop(state, 1);
  lua_pushnil(state);
}

}  // namespace

Script::Script(std::string name, const ScriptOptions& options)
    : random_(options.seed, name),
      name_(std::move(name)),
      first_tick_(options.first_tick),
      max_memory_(options.max_memory),
      max_instructions_(options.max_instructions),
      max_computing_(options.max_computing),
      max_in_library_(options.max_in_library),
      folders_(options.folders),
      most_files_(options.most_files),
      script_(shown(options.script).string()),
      folder_(shown(options.script).parent_path().string()),
      state_(options.max_memory, options.arena) {
  if (folder_.empty()) folder_ = ".";
}

Failure Script::run_chunk() {
  lua_State* const state = state_.get();
  lua_settop(state, 0);
  push_protected(build);
  if (lua_pcall(state, 1, 0, 0) != LUA_OK) return describe_error("its beginning");
  lua_pushcfunction(state, keep_traceback);
  push_protected(load);
  if (lua_pcall(state, 1, 1, 0) != LUA_OK) return describe_error("its beginning");
  return call_prepared("its chunk, tick " + std::to_string(first_tick_), 0, 0);
}

bool Script::has(const char* function) {
  lua_State* const state = state_.get();
  lua_settop(state, 0);
  get_global_if_any(state, function);
  const bool is_there = !lua_isnil(state, -1);
  lua_settop(state, 0);
  return is_there;
}

// Also refreshes the tables.
Failure Script::call(const char* function, bool is_required, const std::string& moment) {
  return call(Wanted{function, is_required, {}}, moment);
}

Failure Script::call(const Wanted& wanted, const std::string& moment, bool* answer) {
  lua_State* const state = state_.get();
  wanted_ = wanted;
  lua_settop(state, 0);
  lua_pushcfunction(state, keep_traceback);
  push_protected(prepare);
  if (lua_pcall(state, 1, 1, handler) != LUA_OK) return describe_error(moment);
  if (lua_isnil(state, -1)) {
    if (!wanted.is_required) return std::nullopt;
    return script_ + ": the script has no function " + wanted.name + "() (in " + moment + ")";
  }
  if (!may_be_called(state)) {
    return script_ + ": " + wanted.name + " is a " + luaL_typename(state, -1) +
           ", not a function; write: function " + wanted.name + "() … end (in " + moment + ")";
  }
  if (wanted.tick) lua_pushinteger(state, static_cast<lua_Integer>(*wanted.tick));
  if (auto failure = call_prepared(moment, wanted.tick ? 1 : 0, answer != nullptr ? 1 : 0)) {
    return failure;
  }
  if (answer != nullptr) *answer = lua_toboolean(state, -1) != 0;
  return std::nullopt;
}

Failure Script::call_prepared(const std::string& moment, int arguments, int results) {
  forget_missing_fields(state_.get());
  const auto status = call_leavably(state_.get(), arguments, results, handler);
  if (!status) {
    state_.abandon();
    return where_left() + " (in " + moment + ")";
  }
  if (*status != LUA_OK) return describe_error(moment);
  return std::nullopt;
}

// Everything that may raise a Lua error runs as a protected function; its argument is this object.
void Script::push_protected(int (*function)(lua_State*)) {
  lua_pushcfunction(state_.get(), function);
  lua_pushlightuserdata(state_.get(), this);
}

int Script::build(lua_State* state) {
  auto& self = *static_cast<Script*>(lua_touserdata(state, 1));
  lua_gc(state, LUA_GCSETPAUSE, pause_of_build);
  prepare_error_messages(state);
  open_libraries(state, {self.log_, self.random_, self.folder_, self.folders_, self.most_files_});
  self.set_up(state);
  return 0;
}

int Script::load(lua_State* state) {
  auto& self = *static_cast<Script*>(lua_touserdata(state, 1));
  // Text only: precompiled chunks can crash the interpreter.
  if (luaL_loadfilex(state, self.script_.c_str(), "t") != LUA_OK) return lua_error(state);
  lua_gc(state, LUA_GCSETPAUSE, pause_of_scripts);
  return 1;
}

int Script::prepare(lua_State* state) {
  auto& self = *static_cast<Script*>(lua_touserdata(state, 1));
  self.keep_small();
  self.refresh(state);
  if (self.wanted_.is_required) {
    lua_getglobal(state, self.wanted_.name);
  } else {
    get_global_if_any(state, self.wanted_.name);
  }
  return 1;
}

/// Collects all garbage when it is worth it. By itself Lua lets a state grow to twice what it
/// needs, and a process has a thousand of them.
void Script::keep_small() {
  constexpr std::size_t calls_between = 32, part = 8;  // of what is in use, at least
  const bool may_collect = ++calls_ >= calls_between || collected_ == 0;
  const std::size_t used = state_.used_bytes();
  if (!may_collect || used <= collected_ + collected_ / part) return;
  if (lua_gc(state_.get(), LUA_GCISRUNNING, 0) == 0) return;  // the script does it itself
  lua_gc(state_.get(), LUA_GCCOLLECT, 0);
  calls_ = 0;
  collected_ = state_.used_bytes();
}

std::string Script::describe_error(const std::string& moment) {
  auto [text, traceback] = take_error_message(state_.get());
  const bool lacked_memory = text.ends_with("not enough memory") ||
                             text.ends_with("not enough memory for buffer allocation");
  if (text == "not enough memory" && *state_.refused_at() != '\0')
    text = std::string(state_.refused_at()) + ": " + text;
  // Most messages of Lua begin with file and line (long paths are shortened), some have neither.
  const auto end = script_.size() < LUA_IDSIZE ? script_ : script_.substr(script_.size() - 40);
  if (text.substr(0, LUA_IDSIZE + 1).find(end + ":") == std::string::npos) {
    text = script_ + ": " + text;
  }
  if (lacked_memory) {
    text += " (it may have " + std::to_string(max_memory_ >> 20) + " MiB)";
  }
  if (const std::string why = why_nil(state_.get(), text); !why.empty()) text += ": " + why;
  text += " (in " + moment + ")";
  return traceback.empty() ? text : text + "\n" + traceback;
}

}  // namespace ziggurat::lua
