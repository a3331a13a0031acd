// SPDX-License-Identifier: MIT
#pragma once
// State of a simulation, which the functions of this folder work on.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "devices/devices.h"
#include "math/archive.h"
#include "media/devices_index.h"
#include "physics/collision/ray.h"
#include "physics/world.h"
#include "simulation/simulation.h"

namespace ziggurat::simulation {

struct Parts {
  Parts(const scene::Scene& scene, const Options& options, world::Layout& layout);

  /// All or nothing.
  void spawn(const scene::Scene& scene, const scene::Entity& entity);
  void grow(const scene::Scene& scene, const scene::Entity& entity);
  void remove(std::size_t entity);
  devices::Tick tick() {
    if (looks_are_old) look_around();
    auto* all = lists_rays ? &all_rays : nullptr;
    return {layout, state, observations, commands, physics, rays, *index, all};
  }
  void list_contacts(bool wanted);
  void look_around();          // rays and index take the poses of the state
  bool looks_are_old = false;  // they have not since something was moved, added or removed
  /// @throws std::runtime_error that names the first entity whose state is not finite then
  void step(timing::Stopwatch* watch);
  void move(std::size_t entity, const math::Pose& pose);

  /// All that the next step reads. @throws math::ArchiveError
  void archive(math::Archive& archive);
  /// Does again what was done to a world that began as this one did. With another seed than the
  /// snapshot's random streams stay at their begin.
  void repeat(const scene::Scene& scene, const Snapshot& snapshot);
  std::vector<std::byte> with_own_streams(const std::vector<std::byte>& given);
  void repeat_edit(const scene::Scene& scene, const WorldEdit& edit);

  std::uint64_t seed;
  unsigned ticks_per_second;
  unsigned substeps;
  double substep;  // [s]
  physics::World physics;
  physics::Rays rays;
  world::Layout& layout;
  world::State state;
  world::Observations observations;
  world::Commands commands;
  std::optional<media::DevicesIndex> index;
  std::vector<world::Contact> contacts;  // of the last substep, if they are listed
  bool lists_contacts = false;
  std::vector<world::Ray> all_rays;  // of the last tick, if they are listed
  bool lists_rays = false;
  devices::Devices devices;
  std::vector<scene::Entity> entities;      // placed, then spawned: as in the layout
  std::size_t in_physics = 0, in_rays = 0;  // entities
  History history;
  std::size_t archive_size = 0;  // of the last snapshot [bytes]
};

/// The first entity with a pose or a velocity that is not finite, into Layout::entities.
std::optional<std::size_t> first_not_finite(const world::Layout& layout, const world::State& state);

}  // namespace ziggurat::simulation
