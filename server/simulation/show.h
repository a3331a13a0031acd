// SPDX-License-Identifier: MIT
#pragma once
// A world whose states are recorded ones: it is shown, not simulated.

#include <cstdint>
#include <span>

#include "scene/scene.h"
#include "simulation/simulation.h"
#include "simulation/snapshot.h"
#include "world/state.h"

namespace ziggurat::simulation {

/// Puts recorded poses and velocities in the place of computed ones, with the LEDs and payloads
/// that are commanded; from then on it can't be stepped. What robots sense stays as it is.
/// @param links  for each of Layout::links
/// @throws SnapshotError if they do not fit this world
void show(Simulation& to, std::uint64_t tick, std::span<const world::LinkState> links);

/// Adds or takes out an entity, also where another one is.
/// @param scene  the one that it was made from
/// @throws SnapshotError if the edit does not fit this world
void repeat(Simulation& to, const scene::Scene& scene, const WorldEdit& edit);

}  // namespace ziggurat::simulation
