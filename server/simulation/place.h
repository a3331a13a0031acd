#pragma once
// Puts everything where it starts: what the scene places, then what it distributes.

#include <cstdint>
#include <vector>

#include "scene/reader.h"
#include "scene/scene.h"

namespace ziggurat::simulation {

/// All entities of the scene at their poses, in scene order: the placed ones, then the
/// distributed ones group by group.
/// @throws scene::SceneError if a distributed entity finds no free place
std::vector<scene::Entity> place(const scene::Scene& scene, std::uint64_t seed);

}  // namespace ziggurat::simulation
