#pragma once
// Trees of an island without active constraints: they move freely, by an integrator of higher
// order.

#include <span>
#include <vector>

#include "dynamics/problem.h"

namespace ziggurat::dynamics {

/// Velocities at the substep's end without constraints, of some trees of an island.
struct UnconstrainedVelocities {
  std::vector<double> velocity;           ///< of each dof, as Problem::velocity
  std::vector<unsigned char> is_known;    ///< of each tree
};

/// Finds the trees of an island on which no constraint but motors of joints acts. Contacts without
/// impulse do not hold them, nor do those that only resolve an overlap.
/// @param problem  solved
/// @param memory   to work in
/// @return         their number
std::size_t find_unconstrained(const Problem& problem, std::span<const Servo> servos, Workspace& work, UnconstrainedVelocities& memory,
                      std::vector<unsigned char>& out);

/// Clears the impulses of contacts between unconstrained trees.
/// @param free  see find_unconstrained()
void clear_contact_impulses(Problem& problem, std::span<const unsigned char> free);

}  // namespace ziggurat::dynamics
