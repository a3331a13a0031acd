#include "devices/device_table.h"

#include "devices/battery.h"
#include "devices/cameras.h"
#include "devices/joints.h"
#include "devices/lights.h"
#include "devices/magnets.h"
#include "devices/positioning.h"
#include "devices/proximity.h"
#include "devices/radios.h"
#include "devices/range_and_bearing.h"
#include "devices/tags.h"
#include "devices/turret.h"
#include "devices/wheels.h"

namespace ziggurat::lua {
namespace {

void refresh_nothing(lua_State*, const ScriptedRobot&) {}

}  // namespace

std::span<const DeviceKind> device_kinds() {
  static constexpr DeviceKind kinds[] = {
      {"battery", has_battery, push_battery, refresh_battery},
      {"cameras", has_cameras, push_cameras, refresh_cameras},
      {"directional_leds", has_directional_leds, push_directional_leds, refresh_nothing},
      {"joints", has_joints, push_joints, refresh_joints},
      {"leds", has_leds, push_leds, refresh_nothing},
      {"magnets", has_magnets, push_magnets, refresh_nothing},
      {"positioning", has_positioning, push_positioning, refresh_positioning},
      {"proximity", has_proximity, push_proximity, refresh_proximity},
      {"radios", has_radios, push_radios, refresh_radios},
      {"range_and_bearing", has_range_and_bearing, push_range_and_bearing,
       refresh_range_and_bearing},
      {"tags", has_tags, push_tags, refresh_nothing},
      {"turret", has_turret, push_turret, refresh_turret},
      {"wheels", has_wheels, push_wheels, refresh_wheels},
  };
  return kinds;
}

}  // namespace ziggurat::lua
