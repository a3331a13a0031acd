// SPDX-License-Identifier: MIT
// robot.debug: draw("arrow(…)(…)(…)"), draw{…}, write(…)

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>

#include "devices/device_table.h"
#include "script/arguments.h"
#include "script/colors.h"
#include "script/guarded.h"
#include "script/trimmed.h"

namespace ziggurat::lua {
namespace {

using Place = std::array<double, 3>;
constexpr const char* usage =
    "'arrow(x,y,z)(x,y,z)(color)', 'ring(x,y,z)(radius)(color)', 'text(x,y,z)(words)(color)', "
    "{at =, to =, color =}, {at =, radius =, color =} or {at =, text =, color =} expected";
constexpr const char* color_usage = "a color is a name such as red, or r,g,b of 0 to 255";

/// The parts of "word(first)(second)(third)"; those that are not there are empty.
struct Parts {
  std::string_view word;
  std::array<std::string_view, 3> groups;
  std::size_t count = 0;
};

/// None: it has another form. Brackets in brackets belong to their group.
std::optional<Parts> split(std::string_view text) {
  Parts parts;
  const std::size_t first = std::min(text.find('('), text.size());
  parts.word = trimmed(text.substr(0, first));
  text.remove_prefix(first);
  for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
    if (text.front() != '(' || parts.count == parts.groups.size()) return std::nullopt;
    std::size_t end = 0;
    for (int depth = 0; end < text.size(); ++end) {
      depth += text[end] == '(' ? 1 : text[end] == ')' ? -1 : 0;
      if (depth == 0) break;
    }
    if (end == text.size()) return std::nullopt;
    parts.groups[parts.count++] = text.substr(1, end - 1);
    text.remove_prefix(end + 1);
  }
  return parts;
}

/// Reads "1, 2.5, -3": as many finite numbers as there is room for.
bool read_numbers(std::string_view text, std::span<double> to) {
  text = trimmed(text);
  if (text.size() > 1 && text.front() == '(' && text.back() == ')') {
    text = text.substr(1, text.size() - 2);
  }
  for (std::size_t i = 0; i < to.size(); ++i) {
    const bool is_last = i + 1 == to.size();
    const std::size_t end = is_last ? text.size() : text.find(',');
    if (end == std::string_view::npos) return false;
    std::string_view number = trimmed(text.substr(0, end));
    if (!number.empty() && number.front() == '+') number.remove_prefix(1);
    const auto [after, error] =
        std::from_chars(number.data(), number.data() + number.size(), to[i]);
    if (error != std::errc() || after != number.data() + number.size()) return false;
    if (!std::isfinite(to[i])) return false;
    text.remove_prefix(is_last ? end : end + 1);
  }
  return true;
}

/// A name, or numbers from 0 to 255, of which fractions are cut off.
std::optional<Color> read_color(std::string_view text) {
  if (const auto color = parse_color(text)) return color;
  std::array<double, 3> values{};
  if (!read_numbers(text, values)) return std::nullopt;
  for (const double value : values) {
    if (value < 0 || value >= 256) return std::nullopt;
  }
  return Color{static_cast<std::uint8_t>(values[0]), static_cast<std::uint8_t>(values[1]),
               static_cast<std::uint8_t>(values[2])};
}

bool is_name_of_color(std::string_view text) {
  return parse_color(text) && text.find(',') == std::string_view::npos;
}

/// Draws what a text says. False: it has another form.
bool draw_text(Robot& robot, std::string_view text) {
  auto parts = split(text);
  if (!parts || parts->count < 2) return false;
  std::array<std::string_view, 3>& groups = parts->groups;
  if (parts->count == 3 && is_name_of_color(groups[0])) {
    std::rotate(groups.begin(), groups.begin() + 1, groups.end());
  }
  const auto color = parts->count == 3 ? read_color(groups[2]) : Color{};
  Place at{}, to{};
  std::array<double, 1> radius{};
  if (!color || !read_numbers(groups[0], at)) return false;
  if (parts->word == "arrow" && read_numbers(groups[1], to)) {
    robot.draw_arrow(at, to, *color);
  } else if (parts->word == "ring" && read_numbers(groups[1], radius)) {
    robot.draw_ring(at, radius[0], *color);
  } else if (parts->word == "text") {
    robot.draw_text(at, groups[1], *color);
  } else {
    return false;
  }
  return true;
}

/// The field `name` of the table at index 1 as a place: {x =, y =, z =} or an array of three.
bool get_place(lua_State* state, const char* name, Place& to) {
  constexpr std::array axes{"x", "y", "z"};
  bool is_place = lua_getfield(state, 1, name) == LUA_TTABLE;
  for (std::size_t i = 0; i < axes.size() && is_place; ++i) {
    if (lua_getfield(state, -1, axes[i]) == LUA_TNIL) {
      lua_pop(state, 1);
      lua_geti(state, -1, static_cast<lua_Integer>(i) + 1);
    }
    is_place = lua_type(state, -1) == LUA_TNUMBER;
    to[i] = lua_tonumber(state, -1);
    lua_pop(state, 1);
  }
  lua_pop(state, 1);
  return is_place;
}

/// The field `color` of the table at index 1; without it black.
Color color_field(lua_State* state) {
  if (lua_getfield(state, 1, "color") == LUA_TNIL) return {};
  const std::string_view text = check_text(state, -1);
  const auto color = read_color(text);
  if (!color) luaL_error(state, "'%s' is no color: %s", text.data(), color_usage);
  lua_pop(state, 1);
  return *color;
}

/// Draws what the table at index 1 says.
void draw_table(lua_State* state) {
  Robot& robot = upvalue<Robot>(state);
  Place at{}, to{};
  const Color color = color_field(state);
  if (!get_place(state, "at", at)) luaL_argerror(state, 1, usage);
  const bool is_arrow = get_place(state, "to", to);
  const bool is_ring = lua_getfield(state, 1, "radius") == LUA_TNUMBER;
  const bool is_text = lua_getfield(state, 1, "text") == LUA_TSTRING;
  if (is_arrow + is_ring + is_text != 1) luaL_argerror(state, 1, usage);
  if (is_arrow) robot.draw_arrow(at, to, color);
  if (is_ring) robot.draw_ring(at, lua_tonumber(state, -2), color);
  if (is_text) robot.draw_text(at, check_text(state, -1), color);
}

int draw(lua_State* state) {
  check_count(state, 1, 1, "draw(text or table)");
  if (lua_istable(state, 1)) {
    draw_table(state);
    return 0;
  }
  const std::string_view text = check_text(state, 1);
  if (!draw_text(upvalue<Robot>(state), text)) {
    luaL_argerror(state, 1,
                  lua_pushfstring(state, "'%s': %s; %s", text.data(), usage, color_usage));
  }
  return 0;
}

void make_debug(lua_State* state, Robot& robot) {
  lua_createtable(state, 0, 2);
  set_function<draw>(state, "draw", &robot);
  lua_getglobal(state, "log");
  lua_setfield(state, -2, "write");
}

}  // namespace

extern const DeviceKind debug_kind{"debug", [](Robot& robot) { return robot.draws(); }, make_debug,
                                   nullptr};

}  // namespace ziggurat::lua
