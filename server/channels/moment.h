// SPDX-License-Identifier: MIT
#pragma once
// Sources of channels: views of a running world.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "timing/phases.h"
#include "world/commands.h"
#include "world/layout.h"
#include "world/state.h"

namespace ziggurat::channels {

/// Who is in the world since the last change.
struct Population {
  const scene::Scene& scene;
  const std::string& path;  ///< of the scene file, as it was given
  const std::string& scene_hash;
  std::uint64_t seed = 1;
  std::uint64_t last_tick = 0;  ///< 0: until stopped
  const world::Layout& layout;
  const std::vector<scene::Entity>& entities;  ///< as placed or spawned, as in the layout
  const world::State& state;
};

/// The world at a tick.
struct Moment {
  const world::State& state;
  const world::Observations& observations;
  const world::Commands& commands;  ///< that led to the state, until the tick is answered
  std::span<const world::Contact> contacts;
  timing::PhaseTimes phases;                             ///< of the tick before
  std::optional<std::span<const world::Ray>> rays = {};  ///< of all devices; nothing: State::rays
  bool has_observations = true;  ///< otherwise channels that show them have no message
};

/// Layers of `/scene` besides the shapes of links.
struct Layers {
  bool labels = false;  ///< ids of entities
  bool frusta = true;   ///< of cameras
};

}  // namespace ziggurat::channels
