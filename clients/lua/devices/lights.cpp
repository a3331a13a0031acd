#include "devices/lights.h"

#include "script/arguments.h"
#include "script/colors.h"
#include "script/guarded.h"

namespace ziggurat::lua {
namespace {

using Lights = std::vector<Setting<Color>>;

/// The colour in the arguments from `first` to the last: a text or three numbers.
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
                                  "'%s' is no colour: a name such as red or gray40, or "
                                  "r,g,b,a of 0 to 255",
                                  text.data()));
  }
  return *color;
}

int set_single_color(lua_State* state) {
  constexpr const char* usage = "set_single_color(index, color) or (index, red, green, blue)";
  check_count(state, 2, 4, usage);
  if (lua_gettop(state) == 3) check_count(state, 4, 4, usage);
  auto& lights = upvalue<Lights>(state);
  const std::size_t position = check_position(state, 1, lights.size(), "LEDs");
  lights[position].set(check_color(state, 2));
  return 0;
}

int set_all_colors(lua_State* state) {
  constexpr const char* usage = "set_all_colors(color) or (red, green, blue)";
  check_count(state, 1, 3, usage);
  if (lua_gettop(state) == 2) check_count(state, 3, 3, usage);
  const Color color = check_color(state, 1);
  for (auto& light : upvalue<Lights>(state)) light.set(color);
  return 0;
}

void push_lights(lua_State* state, Lights& lights) {
  lua_createtable(state, 0, 2);
  set_function<set_single_color>(state, "set_single_color", &lights);
  set_function<set_all_colors>(state, "set_all_colors", &lights);
}

}  // namespace

bool has_leds(const ScriptedRobot& robot) { return !robot.leds.empty(); }
void push_leds(lua_State* state, ScriptedRobot& robot) { push_lights(state, robot.leds); }

bool has_directional_leds(const ScriptedRobot& robot) { return !robot.directional_leds.empty(); }
void push_directional_leds(lua_State* state, ScriptedRobot& robot) {
  push_lights(state, robot.directional_leds);
}

}  // namespace ziggurat::lua
