// SPDX-License-Identifier: MIT
// robot.leds and robot.directional_leds: set_single_color(…), set_all_colors(…)

#include "devices/device_table.h"
#include "script/arguments.h"
#include "script/colors.h"
#include "script/guarded.h"

namespace ziggurat::lua {
namespace {

/// The color in the arguments from `first` to the last: a text or three numbers.
Color check_color(lua_State* state, int first) {
  if (lua_gettop(state) > first) {
    const std::uint8_t red = check_byte(state, first);
    const std::uint8_t green = check_byte(state, first + 1);
    return {red, green, check_byte(state, first + 2)};
  }
  const std::string_view text = check_text(state, first);
  const auto color = parse_color(text);
  if (!color) {
    luaL_argerror(state, first,
                  lua_pushfstring(state,
                                  "'%s' is no color: write a name such as red or gray40, or "
                                  "r,g,b,a of 0 to 255",
                                  text.data()));
  }
  return *color;
}

/// @tparam list  Robot::leds or Robot::directional_leds
template <auto list>
int set_single_color(lua_State* state) {
  constexpr const char* usage = "set_single_color(index, color) or (index, red, green, blue)";
  check_count(state, 2, 4, usage);
  if (lua_gettop(state) == 3) check_count(state, 4, 4, usage);
  const std::span<Led> leds = (upvalue<Robot>(state).*list)();
  const std::size_t position = check_position(state, 1, leds.size(), "LEDs");
  leds[position].set_color(check_color(state, 2));
  return 0;
}

template <auto list>
int set_all_colors(lua_State* state) {
  constexpr const char* usage = "set_all_colors(color) or (red, green, blue)";
  check_count(state, 1, 3, usage);
  if (lua_gettop(state) == 2) check_count(state, 3, 3, usage);
  const Color color = check_color(state, 1);
  for (Led& led : (upvalue<Robot>(state).*list)()) led.set_color(color);
  return 0;
}

template <auto list>
bool has_leds(Robot& robot) {
  return !(robot.*list)().empty();
}

template <auto list>
void make_leds(lua_State* state, Robot& robot) {
  lua_createtable(state, 0, 2);
  set_function<set_single_color<list>>(state, "set_single_color", &robot);
  set_function<set_all_colors<list>>(state, "set_all_colors", &robot);
}

}  // namespace

extern const DeviceKind leds_kind{"leds", has_leds<&Robot::leds>, make_leds<&Robot::leds>, nullptr};
extern const DeviceKind directional_leds_kind{"directional_leds",
                                              has_leds<&Robot::directional_leds>,
                                              make_leds<&Robot::directional_leds>, nullptr};

}  // namespace ziggurat::lua
