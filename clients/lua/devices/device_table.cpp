// SPDX-License-Identifier: MIT
#include "devices/device_table.h"

namespace ziggurat::lua {

// Each in its own file.
extern const DeviceKind battery_kind, cameras_kind, contact_sensors_kind, debug_kind,
    directional_leds_kind, imus_kind, joints_kind, leds_kind, magnets_kind, positioning_kind,
    proximity_kind, radios_kind, range_and_bearing_kind, tags_kind, turret_kind, wheels_kind;

std::span<const DeviceKind* const> device_kinds() {
  static constexpr const DeviceKind* kinds[] = {
      &battery_kind,           &cameras_kind,     &contact_sensors_kind, &debug_kind,
      &directional_leds_kind,  &imus_kind,        &joints_kind,          &leds_kind,
      &magnets_kind,           &positioning_kind, &proximity_kind,       &radios_kind,
      &range_and_bearing_kind, &tags_kind,        &turret_kind,          &wheels_kind,
  };
  return kinds;
}

}  // namespace ziggurat::lua
