// robot.cameras.<id>: led_detector, directional_led_detector, tag_detector, image, and where and
// how the camera looks

#include "devices/device_table.h"
#include "script/tables.h"

namespace ziggurat::lua {
namespace {

/// Places of a camera's tables in the array that fill_cameras() gets, after those of the cameras
/// before it.
enum Slot : int { camera_table, leds_table, directional_leds_table, tags_table, slots };

void push_led(lua_State* state, const Camera::LedReading& led) {
  lua_createtable(state, 0, 2);
  lua_createtable(state, 0, 3);
  set_integer(state, "red", led.color.red);
  set_integer(state, "green", led.color.green);
  set_integer(state, "blue", led.color.blue);
  lua_setfield(state, -2, "color");
  push_vector(state, led.center);
  lua_setfield(state, -2, "center");
}

void push_tag(lua_State* state, const Camera::TagReading& tag) {
  lua_createtable(state, 0, 3);
  lua_pushlstring(state, tag.payload.data(), tag.payload.size());
  lua_setfield(state, -2, "payload");
  push_vector(state, tag.center);
  lua_setfield(state, -2, "center");
  lua_createtable(state, static_cast<int>(tag.corners.size()), 0);
  lua_Integer position = 0;
  for (const Camera::Pixel& corner : tag.corners) {
    push_vector(state, corner);
    lua_rawseti(state, -2, ++position);
  }
  lua_setfield(state, -2, "corners");
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
  lua_createtable(state, slots * count, 0);
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
}

/// Replaces the elements of the array in a slot of the array on top.
template <typename Readings, typename Push>
void fill_slot(lua_State* state, int slot, const Readings& readings, Push push) {
  lua_rawgeti(state, -1, slot);
  set_elements(state, readings, push);
  lua_pop(state, 1);
}

void fill_cameras(lua_State* state, Robot& robot) {
  int first = 1;
  for (const Camera& camera : robot.cameras()) {
    if (camera.detects_leds()) fill_slot(state, first + leds_table, camera.leds(), push_led);
    if (camera.detects_directional_leds()) {
      fill_slot(state, first + directional_leds_table, camera.directional_leds(), push_led);
    }
    if (camera.detects_tags()) fill_slot(state, first + tags_table, camera.tags(), push_tag);
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
