// SPDX-License-Identifier: MIT
#include "script/confined_code.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

#include "script/confined_files.h"
#include "script/guarded.h"

namespace ziggurat::lua {
namespace {

const Folders& usable(lua_State* state) { return upvalue<const Folders>(state); }

/// Only "t", or a mode that accepts nothing.
const char* text_mode(lua_State* state, int index) {
  return std::strchr(luaL_optstring(state, index, "bt"), 't') != nullptr ? "t" : "none";
}

// Upvalue: Lua's load.
int load(lua_State* state) {
  const char* const mode = text_mode(state, 3);
  if (lua_gettop(state) < 3) lua_settop(state, 3);
  lua_pushstring(state, mode);
  lua_replace(state, 3);
  lua_pushvalue(state, lua_upvalueindex(1));
  lua_insert(state, 1);
  lua_call(state, lua_gettop(state) - 1, LUA_MULTRET);
  return lua_gettop(state);
}

/// Pushes the chunk of a file, or a message. @returns LUA_OK if it is the chunk
int push_chunk(lua_State* state, const char* file, const char* mode) {
  if (may_read(usable(state), file)) return luaL_loadfilex(state, file, mode);
  push_refusal(state, file);
  return LUA_ERRFILE;
}

int loadfile(lua_State* state) {
  const char* const file = luaL_checkstring(state, 1);  // not the standard input
  const bool has_environment = lua_gettop(state) >= 3;
  if (push_chunk(state, file, text_mode(state, 2)) != LUA_OK) {
    lua_pushnil(state);
    lua_insert(state, -2);
    return 2;
  }
  if (has_environment) {
    lua_pushvalue(state, 3);
    if (lua_setupvalue(state, -2, 1) == nullptr) lua_pop(state, 1);
  }
  return 1;
}

int dofile(lua_State* state) {
  const char* const file = luaL_checkstring(state, 1);
  lua_settop(state, 1);
  if (push_chunk(state, file, "t") != LUA_OK) return lua_error(state);
  lua_call(state, 0, LUA_MULTRET);
  return lua_gettop(state) - 1;
}

constexpr std::size_t most_templates = 100;

/// Ends as soon as the text is longer than a path may be: a script's memory is bounded, this text
/// is not part of it.
std::string replaced(std::string text, std::string_view from, std::string_view to) {
  if (from.empty()) return text;
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
    if (text.size() > longest_path) break;
  }
  return text;
}

/// Search for a module: the templates of `path` with its name in place of each '?'.
struct Search {
  std::string found;  ///< the first file that exists; empty if none does
  std::string tried;  ///< a line for each that does not
};

Search search(const Folders& folders, std::string_view name, std::string_view path) {
  Search result;
  for (std::size_t i = 0; !path.empty(); ++i) {
    if (i == most_templates) {
      result.tried += "\n\tonly the first 100 places were looked at";
      return result;
    }
    const auto end = std::min(path.find(';'), path.size());
    const std::string file =
        replaced(std::string(path.substr(0, std::min(end, longest_path + 1))), "?", name);
    path.remove_prefix(std::min(end + 1, path.size()));
    std::error_code error;
    if (file.size() > longest_path) {
      result.tried += "\n\tno file, as its path is too long";
    } else if (!folders.contain(file)) {
      result.tried += "\n\t'" + file + "' is outside the folders that scripts may use";
    } else if (std::filesystem::is_regular_file(file, error)) {
      result.found = file;
      return result;
    } else {
      result.tried += "\n\tno file '" + file + "'";
    }
  }
  return result;
}

/// Pushes the file, or nil and what was tried. Lua errors come after the strings are gone.
int push_search(lua_State* state, const char* name, const char* path, const char* from,
                const char* to) {
  for (const char* part : {name, from, to}) {
    if (std::strlen(part) > longest_path)
      return luaL_error(state, "the name of a module is too long");
  }
  const Search result = search(usable(state), replaced(name, from, to), path);
  if (result.found.empty()) lua_pushnil(state);
  const std::string& text = result.found.empty() ? result.tried : result.found;
  lua_pushlstring(state, text.data(), text.size());
  return result.found.empty() ? 2 : 1;
}

int search_path(lua_State* state) {
  const char* const name = luaL_checkstring(state, 1);
  const char* const path = luaL_checkstring(state, 2);
  return push_search(state, name, path, luaL_optstring(state, 3, "."),
                     luaL_optstring(state, 4, "/"));
}

// Upvalue 2: the table `package`.
int find_module(lua_State* state) {
  const char* const name = luaL_checkstring(state, 1);
  lua_getfield(state, lua_upvalueindex(2), "path");
  const char* const path = lua_tostring(state, -1);
  if (path == nullptr) return luaL_error(state, "package.path must be a string");
  if (push_search(state, name, path, ".", "/") == 2) return 1;
  const char* const file = lua_tostring(state, -1);
  if (push_chunk(state, file, "t") != LUA_OK) {
    return luaL_error(state, "error loading module '%s' from file '%s':\n\t%s", name, file,
                      lua_tostring(state, -1));
  }
  lua_pushstring(state, file);
  return 2;
}

template <int (*function)(lua_State*)>
void set_confined(lua_State* state, const char* name, const Folders& folders) {
  set_function<function>(state, name, const_cast<Folders*>(&folders));
}

}  // namespace

void confine_code(lua_State* state, const Folders& folders) {
  lua_pushglobaltable(state);
  lua_getfield(state, -1, "load");
  lua_pushcclosure(state, guarded<load>, 1);
  lua_setfield(state, -2, "load");
  set_confined<loadfile>(state, "loadfile", folders);
  set_confined<dofile>(state, "dofile", folders);
  lua_pop(state, 1);

  lua_getglobal(state, LUA_LOADLIBNAME);
  set_confined<search_path>(state, "searchpath", folders);
  lua_pushliteral(state, "./?.lua;./?/init.lua");
  lua_setfield(state, -2, "path");
  lua_pushliteral(state, "");
  lua_setfield(state, -2, "cpath");
  lua_getfield(state, -1, "searchers");  // of preloaded modules, Lua files, two of C libraries
  lua_pushlightuserdata(state, const_cast<Folders*>(&folders));
  lua_pushvalue(state, -3);
  lua_pushcclosure(state, guarded<find_module>, 2);
  lua_rawseti(state, -2, 2);
  for (int i = static_cast<int>(lua_rawlen(state, -1)); i > 2; --i) {
    lua_pushnil(state);
    lua_rawseti(state, -2, i);
  }
  lua_pop(state, 2);
}

}  // namespace ziggurat::lua
