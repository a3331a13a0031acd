// SPDX-License-Identifier: MIT
#pragma once
// The world at a tick, copied for another thread.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "channels/moment.h"

namespace ziggurat::channels {

/// Who is in the world since the last change.
struct PopulationCopy {
  const scene::Scene& scene;
  std::string path, scene_hash;
  std::uint64_t seed, last_tick;
  world::Layout layout;
  std::vector<scene::Entity> entities;
  world::State state;

  explicit PopulationCopy(const Population& from)
      : scene(from.scene),
        path(from.path),
        scene_hash(from.scene_hash),
        seed(from.seed),
        last_tick(from.last_tick),
        layout(from.layout),
        entities(from.entities),
        state(from.state) {}

  Population view() const {
    return {scene, path, scene_hash, seed, last_tick, layout, entities, state};
  }
};

/// Observations that are copied.
enum class Sensed { nothing, numbers, numbers_and_pictures };

struct TickCopy {
  world::State state;
  world::Observations observations;
  world::Commands commands;
  std::vector<world::Contact> contacts;
  timing::PhaseTimes phases;
  std::optional<std::vector<world::Ray>> rays;  ///< of all devices; nothing: State::rays
  bool has_observations = false;                ///< otherwise they are of another tick

  Moment view() const;
};

/// @param to  keeps its memory
void copy(const Moment& from, Sensed sensed, TickCopy& to);

/// Memory of a copy, about [bytes].
std::size_t size_of(const TickCopy& copy);

}  // namespace ziggurat::channels
