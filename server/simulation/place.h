#pragma once
// Puts everything where it starts: what the scene places, then what it distributes.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "scene/reader.h"
#include "scene/scene.h"

namespace ziggurat::simulation {

/// How many of all entities that are to be distributed have their places.
using TellPlaced = std::function<void(std::size_t placed, std::size_t all)>;

/// When the search for free places ends, whatever 'max_trials' says, of all entities together.
struct Patience {
  std::size_t attempts = 10'000'000;  ///< that fail
  std::size_t effort = 100'000'000;   ///< of those; see physics::Placement; an attempt takes 16, or thousands among thousands of bodies
  std::size_t all_effort = 2'000'000'000;  ///< of those that find a place, too
};

/// All entities of the scene at their poses, in scene order: the placed ones, then the
/// distributed ones group by group.
/// @param tell  told now and then how many entities are distributed already
/// @throws scene::SceneError if a distributed entity finds no free place
std::vector<scene::Entity> place(const scene::Scene& scene, std::uint64_t seed, const TellPlaced& tell = {},
                                 Patience patience = {});

}  // namespace ziggurat::simulation
