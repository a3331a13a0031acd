// SPDX-License-Identifier: MIT
#pragma once
// Devices at given places, each on an entity of its own, without physics.

#include <vector>

#include "media/devices_index.h"
#include "world/layout.h"
#include "world/state.h"

namespace ziggurat::media::testing {

struct Scattered {
  world::Layout layout;
  world::State state;

  /// Adds an entity at `position`; returns the mount of a device at its origin.
  world::Mount place(const math::Vector3& position) {
    state.origins.push_back({position, math::Quaternion::Identity()});
    return {state.origins.size() - 1, std::nullopt, {}};
  }

  std::size_t add_radio(const math::Vector3& position, double range, std::size_t medium = 0) {
    world::RadioLayout radio;
    radio.mount = place(position);
    radio.range = range;
    radio.medium = medium;
    radio.sends = radio.receives = true;
    layout.radios.push_back(radio);
    return layout.radios.size() - 1;
  }

  std::size_t add_range_and_bearing(const math::Vector3& position, double range,
                                    std::size_t bytes) {
    auto& devices = layout.range_and_bearing;
    world::RangeAndBearingLayout device;
    device.mount = place(position);
    device.range = range;
    device.data = {devices.empty() ? 0 : devices.back().data.end(), bytes};
    device.sends = device.receives = true;
    devices.push_back(device);
    return devices.size() - 1;
  }

  DevicesIndex index() const {
    DevicesIndex index(layout);
    index.build(state);
    return index;
  }
};

}  // namespace ziggurat::media::testing
