#include "devices/cameras.h"

#include "devices/kept.h"
#include "script/vectors.h"

namespace ziggurat::lua {
namespace {

// What is kept under its address: an array with the table of each camera, and the arrays
// that it fills, as refresh() finds them whatever the script does with robot.cameras.
constexpr char key = 0;

/// Where in that array a camera's own are, from its first on.
enum Slot : int { table, leds, directional_leds, tags, slots };

void push_reading(lua_State* state, const SeenLed& led) {
  lua_createtable(state, 0, 2);
  lua_createtable(state, 0, 3);
  lua_pushinteger(state, led.color.red);
  lua_setfield(state, -2, "red");
  lua_pushinteger(state, led.color.green);
  lua_setfield(state, -2, "green");
  lua_pushinteger(state, led.color.blue);
  lua_setfield(state, -2, "blue");
  lua_setfield(state, -2, "color");
  push_vector(state, led.center);
  lua_setfield(state, -2, "center");
}

void push_reading(lua_State* state, const SeenTag& tag) {
  lua_createtable(state, 0, 3);
  lua_pushlstring(state, tag.payload.data(), tag.payload.size());
  lua_setfield(state, -2, "payload");
  push_vector(state, tag.center);
  lua_setfield(state, -2, "center");
  lua_createtable(state, static_cast<int>(tag.corners.size()), 0);
  lua_Integer position = 0;
  for (const Pixel& corner : tag.corners) {
    push_vector(state, corner);
    lua_rawseti(state, -2, ++position);
  }
  lua_setfield(state, -2, "corners");
}

/// Puts the readings into the array on top, each as a table of its own that the script may keep.
template <typename Readings>
void fill(lua_State* state, const Readings& readings) {
  lua_Integer position = 0;
  for (const auto& reading : readings) {
    push_reading(state, reading);
    lua_rawseti(state, -2, ++position);
  }
  for (auto left = static_cast<lua_Integer>(lua_rawlen(state, -1)); left > position; --left) {
    lua_pushnil(state);
    lua_rawseti(state, -2, left);
  }
}

void set_image(lua_State* state, Bytes image) {
  lua_pushlstring(state, reinterpret_cast<const char*>(image.data()), image.size());
  lua_setfield(state, -2, "image");
}

/// Sets what does not change of the camera's table on top.
void set_description(lua_State* state, const Camera& camera) {
  lua_pushlstring(state, camera.anchor.data(), camera.anchor.size());
  lua_setfield(state, -2, "anchor");
  push_vector(state, camera.position);
  lua_setfield(state, -2, "position");
  const AngleAxis orientation = to_angle_axis(camera.orientation);
  lua_createtable(state, 0, 2);
  set_number(state, "angle", orientation.angle);
  push_vector(state, orientation.axis);
  lua_setfield(state, -2, "axis");
  lua_setfield(state, -2, "orientation");
  set_number(state, "near", camera.near);
  set_number(state, "far", camera.far);
  push_vector(state, camera.focal_length);
  lua_setfield(state, -2, "focal_length");
  push_vector(state, camera.principal_point);
  lua_setfield(state, -2, "principal_point");
  lua_createtable(state, 0, 2);
  lua_pushinteger(state, camera.resolution[0]);
  lua_setfield(state, -2, "x");
  lua_pushinteger(state, camera.resolution[1]);
  lua_setfield(state, -2, "y");
  lua_setfield(state, -2, "resolution");
}

/// Makes the array of a detector, below `name` of the camera's table on top and in the registry's
/// array beneath that.
template <typename Readings>
void add_detector(lua_State* state, const char* name, int slot, const Readings& readings) {
  lua_newtable(state);
  fill(state, readings);
  lua_pushvalue(state, -1);
  lua_rawseti(state, -4, slot);
  lua_setfield(state, -2, name);
}

/// Fills the array in a slot of the registry's array on top.
template <typename Readings>
void fill_slot(lua_State* state, int slot, const Readings& readings) {
  lua_rawgeti(state, -1, slot);
  fill(state, readings);
  lua_pop(state, 1);
}

}  // namespace

bool has_cameras(const ScriptedRobot& robot) { return !robot.cameras.empty(); }

void push_cameras(lua_State* state, ScriptedRobot& robot) {
  const int count = static_cast<int>(robot.cameras.size());
  lua_createtable(state, 0, count);          // robot.cameras
  lua_createtable(state, slots * count, 0);  // the registry's array
  int first = 1;
  for (const Camera& camera : robot.cameras) {
    lua_createtable(state, 0, 12);
    set_description(state, camera);
    if (camera.detects_leds) add_detector(state, "led_detector", first + leds, camera.leds);
    if (camera.detects_directional_leds) {
      add_detector(state, "directional_led_detector", first + directional_leds,
                   camera.directional_leds);
    }
    if (camera.detects_tags) add_detector(state, "tag_detector", first + tags, camera.tags);
    if (camera.takes_images) set_image(state, camera.image);
    lua_pushvalue(state, -1);
    lua_rawseti(state, -3, first + table);
    lua_pushlstring(state, camera.id.data(), camera.id.size());
    lua_insert(state, -2);
    lua_rawset(state, -4);
    first += slots;
  }
  keep(state, &key, robot);
}

void refresh_cameras(lua_State* state, const ScriptedRobot& robot) {
  push_kept(state, &key, robot);
  int first = 1;
  for (const Camera& camera : robot.cameras) {
    if (camera.detects_leds) fill_slot(state, first + leds, camera.leds);
    if (camera.detects_directional_leds) {
      fill_slot(state, first + directional_leds, camera.directional_leds);
    }
    if (camera.detects_tags) fill_slot(state, first + tags, camera.tags);
    if (camera.takes_images) {
      lua_rawgeti(state, -1, first + table);
      set_image(state, camera.image);
      lua_pop(state, 1);
    }
    first += slots;
  }
  lua_pop(state, 1);
}

}  // namespace ziggurat::lua
