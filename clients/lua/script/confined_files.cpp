// SPDX-License-Identifier: MIT
#include "script/confined_files.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "script/data_files.h"
#include "script/guarded.h"
#include "script/missing_fields.h"
#include "script/open_files.h"

namespace ziggurat::lua {
namespace {

namespace fs = std::filesystem;

// Upvalues of every function here: the folders, and Lua's own function.
const Folders& folders_of(lua_State* state) { return upvalue<const Folders>(state); }

/// Whether a script may create this file, or change it: data alone, as programs, scripts, scenes
/// and what other programs read as instructions have more rights than the script.
bool may_write(const Folders& folders, const char* file) {
  if (!may_read(folders, file) || folders.is_read_only(file) || !is_data_file(file)) return false;
  std::error_code error;
  const auto status = fs::status(file, error);
  constexpr auto may_run = fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec;
  return !fs::exists(status) || (status.permissions() & may_run) == fs::perms::none;
}

/// Calls Lua's own function with the arguments of this one.
int call_original(lua_State* state) {
  lua_pushvalue(state, lua_upvalueindex(2));
  lua_insert(state, 1);
  lua_call(state, lua_gettop(state) - 1, LUA_MULTRET);
  return lua_gettop(state);
}

/// Why a file may not be written.
void push_refusal_to_write(lua_State* state, const char* file) {
  if (std::strlen(file) > longest_path || is_data_file(file)) return push_refusal(state, file);
  lua_pushfstring(
      state,
      "'%s' is not a file that scripts may write: they may write data, whose names end with %s and "
      "are not "
      "those of files that other programs take for instructions; --trust-scripts allows all",
      file, data_endings);
}

/// nil, a message and a number, as Lua returns them for a file that cannot be opened.
template <void (*push)(lua_State*, const char*), int number = EACCES>
int refuse(lua_State* state, const char* file) {
  lua_pushnil(state);
  push(state, file);
  lua_pushinteger(state, number);
  return 3;
}

template <void (*push)(lua_State*, const char*)>
int raise_refusal(lua_State* state, const char* file) {
  luaL_where(state, 1);
  push(state, file);
  lua_concat(state, 2);
  return lua_error(state);
}

int open_or_refuse(lua_State* state) {
  const char* const file = luaL_checkstring(state, 1);
  const char* const mode = luaL_optstring(state, 2, "r");
  const bool reads_only = std::strpbrk(mode, "wa+") == nullptr;
  if (reads_only && !may_read(folders_of(state), file)) return refuse<push_refusal>(state, file);
  if (!reads_only && !may_write(folders_of(state), file))
    return refuse<push_refusal_to_write>(state, file);
  if (!may_open_file(state)) return refuse<push_too_many_files, EMFILE>(state, file);
  const int results = call_original(state);
  count_open_file(state, -results);
  return results;
}

/// io.open: an error about its nil says why.
int open(lua_State* state) {
  const int results = open_or_refuse(state);
  const int first = lua_gettop(state) - results + 1;
  const bool is_refused =
      results > 1 && lua_isnil(state, first) && lua_type(state, first + 1) == LUA_TSTRING;
  note_opening(state, is_refused ? first + 1 : 0);
  return results;
}

/// io.lines, io.input and io.output: a file, its name, or nothing.
template <bool (*may)(const Folders&, const char*), void (*push)(lua_State*, const char*)>
int open_by_name(lua_State* state) {
  if (lua_isstring(state, 1)) {
    const char* const file = lua_tostring(state, 1);
    if (!may(folders_of(state), file)) return raise_refusal<push>(state, file);
    if (!may_open_file(state)) return raise_refusal<push_too_many_files>(state, file);
  }
  const bool opens = lua_isstring(state, 1) != 0;
  const int results = call_original(state);
  if (opens && lua_isfunction(state, -1)) {  // of io.lines: its file is its first value
    if (lua_getupvalue(state, -1, 1) != nullptr) {
      count_open_file(state, -1);
      lua_pop(state, 1);
    }
  } else if (opens) {
    count_open_file(state, -1);
  }
  return results;
}

/// os.remove and os.rename, of regular files only: a link that is moved could lead elsewhere.
template <int names>
int change_names(lua_State* state) {
  for (int i = 1; i <= names; ++i) {
    const char* const file = luaL_checkstring(state, i);
    if (!may_write(folders_of(state), file)) return refuse<push_refusal_to_write>(state, file);
  }
  return call_original(state);
}

template <int (*function)(lua_State*)>
void replace(lua_State* state, const char* name, const Folders& folders) {
  lua_pushlightuserdata(state, const_cast<Folders*>(&folders));
  lua_getfield(state, -2, name);
  lua_pushcclosure(state, guarded<function>, 2);
  lua_setfield(state, -2, name);
}

// A file's metatable is its table of methods, and has its finalizer: a script that changed it could
// run where no instruction is counted.
void hide_metatable_of_files(lua_State* state) {
  luaL_getmetatable(state, LUA_FILEHANDLE);
  lua_newtable(state);
  for (const char* name : {"close", "flush", "lines", "read", "seek", "setvbuf", "write"}) {
    lua_getfield(state, -2, name);
    lua_setfield(state, -2, name);
  }
  lua_setfield(state, -2, "__index");
  lua_pushboolean(state, 0);
  lua_setfield(state, -2, "__metatable");
  lua_pop(state, 1);
}

}  // namespace

bool may_read(const Folders& folders, const char* file) {
  // Its parts would take many times its memory, and that is not part of the script's.
  if (std::strlen(file) > longest_path || !folders.contain(file)) return false;
  std::error_code error;
  const auto status = fs::status(file, error);
  return !fs::exists(status) || fs::is_regular_file(status);  // a pipe could wait forever
}

void push_refusal(lua_State* state, const char* file) {
  lua_pushfstring(
      state,
      "'%s' is not a file that scripts may use this way; they may read and write files in "
      "the folders of the scene and its scripts, but change no programs; --trust-scripts "
      "allows all",
      file);
}

void confine_files(lua_State* state, const Folders& folders, std::size_t most_files) {
  limit_open_files(state, most_files);
  lua_getglobal(state, LUA_IOLIBNAME);
  replace<open>(state, "open", folders);
  replace<open_by_name<may_read, push_refusal>>(state, "lines", folders);
  replace<open_by_name<may_read, push_refusal>>(state, "input", folders);
  replace<open_by_name<may_write, push_refusal_to_write>>(state, "output", folders);
  lua_pop(state, 1);
  lua_getglobal(state, LUA_OSLIBNAME);
  replace<change_names<1>>(state, "remove", folders);
  replace<change_names<2>>(state, "rename", folders);
  lua_pop(state, 1);
  hide_metatable_of_files(state);
}

}  // namespace ziggurat::lua
