#pragma once
// Synchronisation of velocities and positions where trees change between whole substeps and
// leapfrog steps.

#include <span>
#include <vector>

#include "dynamics/system.h"
#include "physics/newton/substep_partition.h"

namespace ziggurat::physics {

/// Time of each tree's velocities relative to its positions.
struct LeapfrogSync {
  enum VelocityTime : unsigned char {
    unknown,  ///< it had a contact or a servo, or is new
    half_step_before,     ///< of half a substep before
    same_time      ///< of now
  };
  std::vector<unsigned char> of_tree, is_constrained;  ///< the second is working memory
};

/// Shifts velocities by half a step's impulse where a tree in free motion changes between both
/// methods, which conserves its energy. Whole substeps apply forces at their beginning, so
/// velocities are those of half a substep before. Leapfrog steps end with velocities of the same
/// time. To be called before a substep, with its external wrenches.
void synchronise_velocities(LeapfrogSync& lags, dynamics::System& system, dynamics::Workspace& work, double time_step, const SubstepPartition* division,
                 std::span<const dynamics::ContactPoint> contacts, std::span<const dynamics::Servo> servos);

}  // namespace ziggurat::physics
