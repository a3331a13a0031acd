// SPDX-License-Identifier: MIT
// robot.cameras.<id>: led_detector, directional_led_detector, tag_detector, image, and where and
// how the camera looks

#include "devices/device_table.h"
#include "script/tables.h"

namespace ziggurat::lua {
namespace {

/// Places of a camera's tables in the array that fill_cameras() gets, after those of the cameras
/// before it.
enum Slot : int { camera_table, leds_table, directional_leds_table, tags_table, slots };
/// Behind them all.
enum Maker : int { led_maker, tag_maker, maker_count };

/// Makers of readings, in Lua: it makes tables in a third of the time that its API takes.
constexpr char makers[] =
    "return function(red, green, blue, u, v)"
    "  return {color = {red = red, green = green, blue = blue}, center = {x = u, y = v}} "
    "end, function(payload, u, v, au, av, bu, bv, cu, cv, du, dv)"
    "  return {payload = payload, center = {x = u, y = v},"
    "          corners = {{x = au, y = av}, {x = bu, y = bv}, {x = cu, y = cv}, {x = du, y = dv}}} "
    "end";

void push_pixel(lua_State* state, const Camera::Pixel& pixel) {
  lua_pushnumber(state, pixel[0]);
  lua_pushnumber(state, pixel[1]);
}

/// Pushes the arguments of the maker. @return  their number
int push_arguments(lua_State* state, const Camera::LedReading& led) {
  lua_pushinteger(state, led.color.red);
  lua_pushinteger(state, led.color.green);
  lua_pushinteger(state, led.color.blue);
  push_pixel(state, led.center);
  return 5;
}

int push_arguments(lua_State* state, const Camera::TagReading& tag) {
  lua_pushlstring(state, tag.payload.data(), tag.payload.size());
  push_pixel(state, tag.center);
  for (const Camera::Pixel& corner : tag.corners) push_pixel(state, corner);
  return 3 + 2 * static_cast<int>(tag.corners.size());
}

/// Sets what does not change of the camera's table on top.
void set_description(lua_State* state, const Camera& camera) {
  lua_pushlstring(state, camera.anchor().data(), camera.anchor().size());
  lua_setfield(state, -2, "anchor");
  push_vector(state, camera.position());
  lua_setfield(state, -2, "position");
  push_orientation(state, camera.orientation());
  lua_setfield(state, -2, "orientation");
  set_number(state, "near", camera.near());
  set_number(state, "far", camera.far());
  push_vector(state, camera.focal_length());
  lua_setfield(state, -2, "focal_length");
  push_vector(state, camera.principal_point());
  lua_setfield(state, -2, "principal_point");
  lua_createtable(state, 0, 2);
  set_integer(state, "x", camera.width());
  set_integer(state, "y", camera.height());
  lua_setfield(state, -2, "resolution");
}

/// Sets field `name` of the camera's table on top, and a slot of the array beneath it, to a new
/// array.
void add_detector(lua_State* state, const char* name, int slot) {
  lua_newtable(state);
  lua_pushvalue(state, -1);
  lua_rawseti(state, -4, slot);
  lua_setfield(state, -2, name);
}

/// Second, the array of slots.
void make_cameras(lua_State* state, Robot& robot) {
  const int count = static_cast<int>(robot.cameras().size());
  lua_createtable(state, 0, count);
  lua_createtable(state, slots * count + maker_count, 0);
  int first = 1;
  for (const Camera& camera : robot.cameras()) {
    lua_createtable(state, 0, 12);
    set_description(state, camera);
    if (camera.detects_leds()) add_detector(state, "led_detector", first + leds_table);
    if (camera.detects_directional_leds()) {
      add_detector(state, "directional_led_detector", first + directional_leds_table);
    }
    if (camera.detects_tags()) add_detector(state, "tag_detector", first + tags_table);
    lua_pushvalue(state, -1);
    lua_rawseti(state, -3, first + camera_table);
    set_element(state, -3, camera.id());
    first += slots;
  }
  if (luaL_loadstring(state, makers) != LUA_OK) lua_error(state);
  lua_call(state, 0, maker_count);
  lua_rawseti(state, -3, first + tag_maker);
  lua_rawseti(state, -2, first + led_maker);
}

/// Replaces the elements of the array in a slot of the array on top.
template <typename Readings>
void fill_slot(lua_State* state, int slot, int maker, const Readings& readings) {
  lua_rawgeti(state, -1, maker);
  lua_rawgeti(state, -2, slot);
  set_elements(state, readings, [](lua_State* to, const auto& reading) {
    lua_pushvalue(to, -2);
    lua_call(to, push_arguments(to, reading), 1);
  });
  lua_pop(state, 2);
}

void fill_cameras(lua_State* state, Robot& robot) {
  int first = 1;
  const int first_maker = first + slots * static_cast<int>(robot.cameras().size());
  const int led = first_maker + led_maker, tag = first_maker + tag_maker;
  for (const Camera& camera : robot.cameras()) {
    if (camera.detects_leds()) fill_slot(state, first + leds_table, led, camera.leds());
    if (camera.detects_directional_leds()) {
      fill_slot(state, first + directional_leds_table, led, camera.directional_leds());
    }
    if (camera.detects_tags()) fill_slot(state, first + tags_table, tag, camera.tags());
    if (camera.takes_images()) {
      const Bytes image = camera.image();
      lua_rawgeti(state, -1, first + camera_table);
      lua_pushlstring(state, reinterpret_cast<const char*>(image.data()), image.size());
      lua_setfield(state, -2, "image");
      lua_pop(state, 1);
    }
    first += slots;
  }
}

}  // namespace

extern const DeviceKind cameras_kind{
    "cameras", [](Robot& robot) { return !robot.cameras().empty(); }, make_cameras, fill_cameras};

}  // namespace ziggurat::lua
