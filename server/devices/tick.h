// SPDX-License-Identifier: MIT
#pragma once
// Context that devices are built from, and the data that they work on in a tick.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "media/devices_index.h"
#include "physics/collision/ray.h"
#include "physics/world.h"
#include "scene/scene.h"
#include "world/commands.h"
#include "world/layout.h"
#include "world/limits.h"
#include "world/state.h"

namespace ziggurat::devices {

/// The world at its start, or what was added since the last call.
struct Setting {
  const scene::Scene& scene;
  std::span<const scene::Entity> entities;  ///< the new ones, placed, in scene order
  const world::Layout& layout;              ///< of all; outlives the devices
  std::uint64_t seed;                       ///< of random streams
  double tick_length;                       ///< simulated time per tick [s]
  double substep;                           ///< physical time per substep [s]
  physics::World& physics;
  std::size_t first_entity = 0, first_robot = 0;  ///< into the layout: the first new ones
  /// All entities as they were placed, in scene order; costs time.
  std::function<std::vector<scene::Entity>()> all_entities = {};

  /// @param entity  into Layout::entities, a new one
  const scene::Entity& entity(std::size_t entity) const { return entities[entity - first_entity]; }
  std::span<const world::RobotLayout> new_robots() const {
    return std::span(layout.robots).subspan(first_robot);
  }
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
  std::vector<world::Ray>* all_rays = nullptr;          ///< gets those of all devices; may be null
  std::size_t lines_left = world::most_lines_of_sight;  ///< of blob cameras and light sensors

  /// Counts a line of sight. @throws std::runtime_error if there are too many
  void take_line() {
    if (lines_left-- > 0) return;
    throw std::runtime_error("blob cameras and light sensors look along more than " +
                             std::to_string(world::most_lines_of_sight) +
                             " lines of sight at a tick; write fewer of them, fewer lights, or "
                             "smaller ranges and apertures");
  }

  /// Shows a ray up to what it met, if it met something.
  /// @param ray           to the end of its way
  /// @param is_asked_for  by the device: `show_rays`
  void show(world::Ray ray, const std::optional<physics::RayHit>& met, bool is_asked_for) {
    if (!is_asked_for && !all_rays) return;
    ray.hit = met.has_value();
    if (met) ray.end = ray.start + met->distance * (ray.end - ray.start).normalized();
    if (is_asked_for) state.rays.push_back(ray);
    if (all_rays) all_rays->push_back(ray);
  }
};

}  // namespace ziggurat::devices
