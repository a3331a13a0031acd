#include "devices/devices_to_come.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace ziggurat::lua {
namespace {

/// Elements whose table has another name.
constexpr std::pair<std::string_view, const char*> names[] = {
    {"footbot_gripper", "gripper"},
};

}  // namespace

void set_devices_to_come(lua_State* state, const Robot& robot) {
  for (const std::string& element : robot.devices_to_come()) {
    const auto* const found =
        std::ranges::find(names, element, [](const auto& each) { return each.first; });
    const char* const name = found == std::end(names) ? element.c_str() : found->second;
    lua_createtable(state, 0, 0);
    lua_setfield(state, -2, name);
  }
}

}  // namespace ziggurat::lua
