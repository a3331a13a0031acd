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

/// All entities of the scene at their poses, in scene order: the placed ones, then the
/// distributed ones group by group.
/// @param tell           told now and then how many entities are distributed already
/// @param most_attempts  that fail, of all entities together: whatever 'max_trials' says, the search ends
/// @throws scene::SceneError if a distributed entity finds no free place
std::vector<scene::Entity> place(const scene::Scene& scene, std::uint64_t seed, const TellPlaced& tell = {},
                                 std::size_t most_attempts = 10'000'000);

}  // namespace ziggurat::simulation
