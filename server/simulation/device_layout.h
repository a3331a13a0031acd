#pragma once
// The devices of one entity in the flat lists.

#include <cstddef>

#include "scene/scene.h"
#include "world/layout.h"

namespace ziggurat::simulation {

struct DeviceCarrier {
  const scene::Entity& entity;
  std::size_t index;                        ///< into Layout::entities, where it stands already
  const scene::ControllerDevices& enabled;  ///< by its controller; nothing without one
};

/// Appends what the entity carries, as far as anything can come of it.
/// @param robot  gets the ranges of what its controller enables
void add_devices(const DeviceCarrier& carrier, world::RobotLayout& robot, world::Layout& layout);

}  // namespace ziggurat::simulation
