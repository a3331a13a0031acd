#pragma once
// What devices are built from, and what they work on in a tick.

#include <cstdint>
#include <vector>

#include "media/devices_index.h"
#include "physics/ray.h"
#include "physics/world.h"
#include "scene/scene.h"
#include "world/layout.h"
#include "world/state.h"

namespace ziggurat::devices {

struct Setting {
  const scene::Scene& scene;
  const std::vector<scene::Entity>& entities;  ///< all, placed, in scene order
  const world::Layout& layout;                 ///< outlives the devices
  std::uint64_t seed;                          ///< of random streams
  double tick_length;                          ///< simulated time per tick [s]

  const scene::ControllerDevices& enabled(const world::RobotLayout& robot) const {
    return scene.controllers[robot.controller].devices;
  }
};

struct Tick {
  const world::Layout& layout;
  world::State& state;
  world::Observations& observations;
  world::Commands& commands;
  physics::World& physics;
  const physics::Rays& rays;
  const media::DevicesIndex& index;
};

}  // namespace ziggurat::devices
