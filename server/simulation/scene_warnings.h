#pragma once
// What a person would ask about when they see a scene at its start.

#include <vector>

#include "scene/problem.h"
#include "scene/scene.h"
#include "simulation/simulation.h"

namespace ziggurat::simulation {

/// Warnings on bodies that overlap, that begin in the floor or outside of the arena, that fall forever,
/// whose size has nothing to do with the arena's, or whose joints are far from it. One of each kind, with how many there are.
/// @param simulation  of the scene, at tick 0
std::vector<scene::Problem> scene_warnings(const scene::Scene& scene, const Simulation& simulation);

}  // namespace ziggurat::simulation
