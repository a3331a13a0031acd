// SPDX-License-Identifier: MIT
#pragma once
// Puts everything where it starts: what the scene places, then what it distributes.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "scene/reader.h"
#include "scene/scene.h"

namespace ziggurat::simulation {

/// A world is made in these steps, entity by entity: those of `<distribute>` get places, then all
/// get bodies.
enum class Step { placing, building };
/// With how many entities a step is done, of all that it has.
using TellStep = std::function<void(Step step, std::size_t done, std::size_t all)>;

/// When the search for free places ends, whatever 'max_trials' says, of all entities together.
struct SearchLimits {
  std::size_t attempts = 10'000'000;  ///< that fail
  std::size_t effort = 100'000'000;   ///< of those; see physics::Placement; an attempt takes 16, or
                                      ///< thousands among thousands of bodies
  std::size_t all_effort = 2'000'000'000;  ///< of those that find a place, too
};

/// All entities of the scene at their poses, in scene order: the placed ones, then the
/// distributed ones group by group.
/// @param tell  told now and then how many entities are distributed already
/// @throws scene::SceneError if a distributed entity finds no free place
std::vector<scene::Entity> place_entities(const scene::Scene& scene, std::uint64_t seed,
                                          const TellStep& tell = {}, SearchLimits limits = {});

}  // namespace ziggurat::simulation
