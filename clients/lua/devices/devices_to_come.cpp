#include "devices/devices_to_come.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace ziggurat::lua {
namespace {

/// Elements whose table has another name.
constexpr std::pair<std::string_view, const char*> names[] = {
    {"footbot_light", "light"},
    {"footbot_base_ground", "base_ground"},
    {"footbot_motor_ground", "motor_ground"},
    {"footbot_distance_scanner", "distance_scanner"},
    {"footbot_gripper", "gripper"},
    {"quadrotor_position", "quadrotor"},
    {"quadrotor_speed", "quadrotor"},
};

int do_nothing(lua_State*) { return 0; }

/// Whether scripts switch the device on before they read it.
bool is_switched(std::string_view name) {
  return name.starts_with("colored_blob_") || name == "distance_scanner";
}

}  // namespace

void set_devices_to_come(lua_State* state, const Robot& robot) {
  for (const std::string& element : robot.devices_to_come()) {
    const auto* const found =
        std::ranges::find(names, element, [](const auto& each) { return each.first; });
    const char* const name = found == std::end(names) ? element.c_str() : found->second;
    lua_createtable(state, 0, 2);
    if (is_switched(name)) {
      for (const char* function : {"enable", "disable"}) {
        lua_pushcfunction(state, do_nothing);
        lua_setfield(state, -2, function);
      }
    }
    lua_setfield(state, -2, name);
  }
}

}  // namespace ziggurat::lua
