#pragma once
// Which trees of an island nothing holds: they may fly, and so move by an integrator of second order.

#include <span>
#include <vector>

#include "dynamics/problem.h"

namespace ziggurat::dynamics {

/// Velocities at the substep's end if nothing touched, of the trees of an island that were asked for.
struct UnconstrainedVelocities {
  std::vector<double> velocity;           ///< of each dof, as Problem::velocity
  std::vector<unsigned char> is_known;    ///< of each tree
};

/// Notes which trees of an island nothing but motors of joints acts on: what they come near does not hold them, and what they
/// overlap only pushes them out.
/// @param problem  solved
/// @param memory   to work in
/// @return         how many
std::size_t find_unconstrained(const Problem& problem, std::span<const Servo> servos, Workspace& work, UnconstrainedVelocities& memory,
                      std::vector<unsigned char>& out);

/// Contacts of trees that fly gave nothing.
/// @param free  see find_unconstrained()
void clear_contact_impulses(Problem& problem, std::span<const unsigned char> free);

}  // namespace ziggurat::dynamics
