#pragma once
// At which time the speeds of trees are that forces change too fast for whole substeps.

#include <span>
#include <vector>

#include "dynamics/system.h"
#include "physics/newton/substep_partition.h"

namespace ziggurat::physics {

/// Of each tree.
struct LeapfrogSync {
  enum VelocityTime : unsigned char {
    unknown,  ///< it met something, was driven, or is new
    half_step_before,     ///< of half a substep before
    same_time      ///< of now
  };
  std::vector<unsigned char> of_tree, is_constrained;  ///< the second is working memory
};

/// A whole substep takes what pushes as an impulse at its beginning, so that speeds are those of half a substep before; in parts
/// they are those of now. What flies freely from one to the other keeps its energy if its speeds change by what pushes in that half.
/// To be called before a substep, with what pushes in it.
/// @param length    of the substep [s]
/// @param division  of it; null: nothing is divided
void synchronise_velocities(LeapfrogSync& lags, dynamics::System& system, dynamics::Workspace& work, double time_step, const SubstepPartition* division,
                 std::span<const dynamics::ContactPoint> contacts, std::span<const dynamics::Servo> servos);

}  // namespace ziggurat::physics
