// SPDX-License-Identifier: MIT
#pragma once
// Warnings about the start of a scene.

#include <vector>

#include "scene/problem.h"
#include "scene/scene.h"
#include "simulation/simulation.h"

namespace ziggurat::simulation {

/// Warns of bodies that overlap, begin in the floor or outside of the arena, or fall forever; also
/// of sizes and joints far from the arena's. One warning of each kind, with the number of cases.
/// @param simulation  of the scene, at tick 0
std::vector<scene::Problem> scene_warnings(const scene::Scene& scene, const Simulation& simulation);

}  // namespace ziggurat::simulation
