// SPDX-License-Identifier: MIT
#include "script/missing_fields.h"

#include <algorithm>
#include <array>
#include <vector>

namespace ziggurat::lua {
namespace {

// Their addresses are keys of the registry.
constexpr char watched_key = 0, name_key = 0, owner_key = 0, root_key = 0, table_key = 0,
               field_key = 0, opening_key = 0;

constexpr int deepest = 3;              // robot.joints.<id>.<field>
constexpr std::size_t most_named = 24;  // fields of a message
constexpr int most_read = 10'000;       // fields, as scripts can make any tables

/// __index: remembers the table and the field.
int remember(lua_State* state) {
  lua_settop(state, 2);
  if (lua_type(state, 2) == LUA_TSTRING) {
    lua_rawsetp(state, LUA_REGISTRYINDEX, &field_key);
    lua_rawsetp(state, LUA_REGISTRYINDEX, &table_key);
  }
  lua_pushnil(state);
  return 1;
}

/// The table on top and those in it.
void watch_table(lua_State* state, int depth) {
  if (lua_getmetatable(state, -1) != 0) {
    lua_pop(state, 1);
    return;
  }
  lua_rawgetp(state, LUA_REGISTRYINDEX, &watched_key);
  lua_setmetatable(state, -2);
  if (depth == deepest) return;
  luaL_checkstack(state, 4, nullptr);
  lua_pushnil(state);
  while (lua_next(state, -2) != 0) {
    if (lua_type(state, -1) == LUA_TTABLE && lua_type(state, -2) == LUA_TSTRING)
      watch_table(state, depth + 1);
    lua_pop(state, 1);
  }
}

/// The name of the table at `wanted` below the one on top; empty if it is not there.
/// @param left  so many fields may still be read
std::string name_of(lua_State* state, int wanted, const std::string& name, int depth, int& left) {
  if (lua_rawequal(state, -1, wanted) != 0) return name;
  if (depth == deepest || lua_checkstack(state, 4) == 0) return {};
  const int top = lua_gettop(state);
  std::string found;
  lua_pushnil(state);
  while (found.empty() && left-- > 0 && lua_next(state, -2) != 0) {
    if (lua_type(state, -1) == LUA_TTABLE && lua_type(state, -2) == LUA_TSTRING) {
      found = name_of(state, wanted, name + "." + lua_tostring(state, -2), depth + 1, left);
    }
    lua_pop(state, 1);
  }
  lua_settop(state, top);
  return found;
}

/// Names of the fields of the table at that index.
std::string fields_of(lua_State* state, int table) {
  std::vector<std::string> names;
  lua_pushnil(state);
  for (int left = most_read; left > 0 && lua_next(state, table) != 0; --left) {
    if (lua_type(state, -2) == LUA_TSTRING) names.emplace_back(lua_tostring(state, -2));
    lua_pop(state, 1);
  }
  std::ranges::sort(names);
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), most_named); ++i)
    text += (i == 0 ? "" : ", ") + names[i];
  if (names.size() > most_named)
    text += " and " + std::to_string(names.size() - most_named) + " more";
  return text.empty() ? "nothing" : text;
}

bool contains(std::string_view text, std::string_view part) { return text.find(part) != text.npos; }

/// Whether the error is about a nil value that Lua names no variable for, as in a comparison.
bool is_unnamed(std::string_view error) {
  if (!contains(error, "nil") && !contains(error, "'for' ")) return false;
  const auto is_named = [&](std::string_view kind) { return contains(error, kind); };
  return std::ranges::none_of(
      std::array{"(global '", "(local '", "(field '", "(upvalue '", "(method '"}, is_named);
}

/// Whether the error is about a nil value in a field or variable of that name.
bool is_about(std::string_view error, const std::string& field) {
  return contains(error, "nil value") && contains(error, " '" + field + "')");
}

/// Message of io.open, for an error about a nil value.
std::string of_opening(lua_State* state, std::string_view error) {
  if (!contains(error, "nil value") && !contains(error, "got nil")) return {};
  std::string text;
  if (lua_rawgetp(state, LUA_REGISTRYINDEX, &opening_key) == LUA_TSTRING) {
    text = std::string("io.open has returned nil: ") + lua_tostring(state, -1);
  }
  lua_pop(state, 1);
  return text;
}

}  // namespace

void watch_missing_fields(lua_State* state, const char* name, const char* kind, const char* id) {
  lua_createtable(state, 0, 1);
  lua_pushcfunction(state, remember);
  lua_setfield(state, -2, "__index");
  lua_rawsetp(state, LUA_REGISTRYINDEX, &watched_key);
  lua_pushstring(state, name);
  lua_rawsetp(state, LUA_REGISTRYINDEX, &name_key);
  lua_pushfstring(state, "%s '%s'", kind, id);
  lua_rawsetp(state, LUA_REGISTRYINDEX, &owner_key);
  lua_pushvalue(state, -1);
  lua_rawsetp(state, LUA_REGISTRYINDEX, &root_key);
  lua_pushnil(state);  // so that remember() needs no memory for new keys
  lua_rawsetp(state, LUA_REGISTRYINDEX, &field_key);
  watch_table(state, 1);
  lua_pushglobaltable(state);
  watch_table(state, deepest);
  lua_pop(state, 1);
}

void forget_missing_fields(lua_State* state) {
  lua_pushnil(state);
  lua_rawsetp(state, LUA_REGISTRYINDEX, &field_key);
}

void note_opening(lua_State* state, int message) {
  message == 0 ? lua_pushnil(state) : lua_pushvalue(state, message);
  lua_rawsetp(state, LUA_REGISTRYINDEX, &opening_key);
}

namespace {

std::string of_field(lua_State* state, std::string_view error) {
  const int top = lua_gettop(state);
  std::string text;
  if (lua_checkstack(state, 8) == 0) return text;
  const bool is_set = lua_rawgetp(state, LUA_REGISTRYINDEX, &field_key) == LUA_TSTRING &&
                      lua_rawgetp(state, LUA_REGISTRYINDEX, &table_key) == LUA_TTABLE &&
                      lua_rawgetp(state, LUA_REGISTRYINDEX, &owner_key) == LUA_TSTRING &&
                      lua_rawgetp(state, LUA_REGISTRYINDEX, &name_key) == LUA_TSTRING &&
                      lua_rawgetp(state, LUA_REGISTRYINDEX, &root_key) == LUA_TTABLE;
  if (is_set) {
    const int table = top + 2;
    const std::string field = lua_tostring(state, top + 1), root = lua_tostring(state, top + 4);
    int left = most_read;
    lua_pushglobaltable(state);
    const bool is_global = lua_rawequal(state, table, -1) != 0;
    lua_pop(state, 1);
    const std::string name = is_global ? "" : name_of(state, table, root, 1, left);
    if (is_global && is_unnamed(error)) {
      text = "the last global that was read, '" + field + "', is nil";
    } else if (!name.empty() && (is_about(error, field) || is_unnamed(error))) {
      text = std::string(lua_tostring(state, top + 3)) + " has no " + name + "." + field + "; " +
             name + " has: " + fields_of(state, table);
    }
  }
  lua_settop(state, top);
  return text;
}

}  // namespace

std::string why_nil(lua_State* state, std::string_view error) {
  const std::string field = of_field(state, error);
  return field.empty() ? of_opening(state, error) : field;
}

}  // namespace ziggurat::lua
