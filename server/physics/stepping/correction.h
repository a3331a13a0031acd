// SPDX-License-Identifier: MIT
#pragma once
// Corrections of an island's velocities at the end of its step, in their order. The mass matrices
// were those of the step's beginning, and the pose is another one now.

#include <array>
#include <span>

#include "physics/solver/problem.h"
#include "physics/stepping/energy_error.h"

namespace ziggurat::dynamics {

/// An island at the end of its step: solved and displaced.
struct IslandEnd {
  const Problem& problem;
  Workspace& work;
  const IslandEnergyErrors& energy_errors;
  std::span<const unsigned char> is_free;  ///< of each tree: it was integrated in free motion
  bool has_world_friction = false;         ///< so the momentum of its trees is not conserved
};

/// A correction of one tree, which is not free.
struct Correction {
  const char* name;
  bool (*applies)(const IslandEnd& end, std::size_t tree);
  void (*apply)(const IslandEnd& end, std::size_t tree);
};

/// All corrections, in their order.
extern const std::array<Correction, 2> corrections;

/// Whether the world has friction with a problem's trees.
bool has_world_friction(const Problem& problem);

/// Applies all corrections to the trees of an island that are not free.
void correct(const IslandEnd& end);

}  // namespace ziggurat::dynamics
