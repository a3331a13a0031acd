// SPDX-License-Identifier: MIT
#include "rules.h"

#include <algorithm>
#include <array>
#include <lua.hpp>
#include <memory>
#include <stdexcept>
#include <string_view>

namespace assembly {
namespace {

struct Close {
  void operator()(lua_State* state) const { lua_close(state); }
};

constexpr int most_instructions = 1'000'000;
constexpr std::size_t most_rows = 100;
constexpr std::array<std::string_view, 4> side_names = {"front", "left", "back", "right"};

void stop(lua_State* state, lua_Debug* /*where*/) {
  luaL_error(state, "it is not done after %d instructions", most_instructions);
}

std::string text_of(lua_State* state, int table, const char* field) {
  const bool is_text = lua_getfield(state, table, field) == LUA_TSTRING;
  std::string text = is_text ? lua_tostring(state, -1) : "";
  lua_pop(state, 1);
  if (!is_text) throw std::runtime_error(std::string("'") + field + "' is not a string");
  return text;
}

/// Takes the number on top from the stack.
int pop_number(lua_State* state, const char* name, int max) {
  int is_number = 0;
  const lua_Integer number = lua_tointegerx(state, -1, &is_number);
  lua_pop(state, 1);
  if (is_number != 0 && number >= 0 && number <= max) return static_cast<int>(number);
  throw std::runtime_error(std::string("'") + name + "' is not from 0 to " + std::to_string(max));
}

ziggurat::Color color_of(lua_State* state, int table) {
  std::array<std::uint8_t, 3> parts{};
  if (lua_getfield(state, table, "shows") != LUA_TTABLE) {
    throw std::runtime_error("'shows' is missing; write {red, green, blue}, from 0 to 255");
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    lua_rawgeti(state, -1, static_cast<lua_Integer>(i) + 1);
    parts[i] = static_cast<std::uint8_t>(pop_number(state, "shows", 255));
  }
  lua_pop(state, 1);
  return {parts[0], parts[1], parts[2]};
}

void read_sides(lua_State* state, int table, Row& row) {
  const int type = lua_getfield(state, table, "sides");
  row.is_everywhere = type == LUA_TNIL;
  if (row.is_everywhere) row.sides.fill(true);
  const std::size_t count = type == LUA_TTABLE ? lua_rawlen(state, -1) : 0;
  if (!row.is_everywhere && (count < 1 || count > row.sides.size())) {
    throw std::runtime_error(R"('sides' is not a list, as {"front", "back"})");
  }
  for (std::size_t i = 1; i <= count; ++i) {
    lua_rawgeti(state, -1, static_cast<lua_Integer>(i));
    const char* name = lua_tostring(state, -1);
    const auto found = std::ranges::find(side_names, name ? name : "");
    if (found == side_names.end()) {
      throw std::runtime_error(
          R"('sides' has something else than "front", "left", "back", "right")");
    }
    row.sides[static_cast<std::size_t>(found - side_names.begin())] = true;
    lua_pop(state, 1);
  }
  lua_pop(state, 1);
}

/// The row on top of the stack. States have numbers in the order in which the table names them.
Row read_row(lua_State* state, std::vector<std::string>& states) {
  if (!lua_istable(state, -1)) throw std::runtime_error("it is not a table");
  const int table = lua_gettop(state);
  Row row;
  row.shows = color_of(state, table);
  lua_getfield(state, table, "height");
  row.height = pop_number(state, "height", 255);
  const std::string place = text_of(state, table, "place");
  if (place != "above" && place != "before") {
    throw std::runtime_error("'place' is \"" + place + R"("; write "above" or "before")");
  }
  row.above = place == "above";
  read_sides(state, table, row);
  row.state = text_of(state, table, "state");
  row.becomes = text_of(state, table, "becomes");
  auto found = std::ranges::find(states, row.becomes);
  if (found == states.end()) found = states.insert(states.end(), row.becomes);
  row.number = static_cast<std::uint8_t>(found - states.begin() + 1);
  return row;
}

Plan read_rows(lua_State* state) {
  if (!lua_istable(state, -1)) throw std::runtime_error("it returns no table");
  const std::size_t count = lua_rawlen(state, -1);
  if (count > most_rows) {
    throw std::runtime_error("it has more than " + std::to_string(most_rows) + " rows");
  }
  std::vector<std::string> states = {text_of(state, lua_gettop(state), "seed")};
  Plan plan;
  for (std::size_t i = 1; i <= count; ++i) {
    lua_rawgeti(state, -1, static_cast<lua_Integer>(i));
    try {
      plan.rows.push_back(read_row(state, states));
    } catch (const std::runtime_error& error) {
      throw std::runtime_error("row " + std::to_string(i) + ": " + error.what());
    }
    plan.rows.back().index = static_cast<std::uint8_t>(i);
    lua_pop(state, 1);
  }
  return plan;
}

}  // namespace

const Row* Plan::row_of(std::size_t index) const {
  return index > 0 && index <= rows.size() ? &rows[index - 1] : nullptr;
}

const Row* Plan::row_for(const std::string& state, int height, int side, bool is_occupied) const {
  const auto found = std::ranges::find_if(rows, [&](const Row& row) {
    return row.state == state && row.height == height && (row.above || !is_occupied) &&
           row.sides[static_cast<std::size_t>(side)];
  });
  return found == rows.end() ? nullptr : &*found;
}

const Row* Plan::row_shown(ziggurat::Color color) const {
  const auto found = std::ranges::find(rows, color, &Row::shows);
  return found == rows.end() ? nullptr : &*found;
}

const Row* Plan::origin_of(const Row& row, const std::string& state) const {
  const auto found = std::ranges::find_if(rows, [&](const Row& origin) {
    return !origin.above && origin.becomes == row.state && origin.state == state;
  });
  return found == rows.end() ? nullptr : &*found;
}

Plan read_plan(const std::string& path) {
  const std::unique_ptr<lua_State, Close> state(luaL_newstate());
  if (!state) throw std::bad_alloc();
  lua_sethook(state.get(), stop, LUA_MASKCOUNT, most_instructions);
  if (luaL_loadfilex(state.get(), path.c_str(), "t") != LUA_OK ||
      lua_pcall(state.get(), 0, 1, 0) != LUA_OK) {
    const char* message = lua_tostring(state.get(), -1);
    throw std::runtime_error(path + ": " + (message ? message : "it fails"));
  }
  try {
    return read_rows(state.get());
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
}

}  // namespace assembly
