// SPDX-License-Identifier: MIT
#pragma once
// Trees of an island without active constraints: they move freely, by an integrator of higher
// order.

#include <span>
#include <vector>

#include "physics/solver/problem.h"

namespace ziggurat::dynamics {

/// Velocities at the substep's end without constraints, of some trees of an island.
struct UnconstrainedVelocities {
  std::vector<double> velocity;         ///< of each dof, as Problem::velocity
  std::vector<unsigned char> is_known;  ///< of each tree
};

/// Finds the trees of an island on which no constraint but motors of joints acts. Contacts without
/// impulse do not hold them, nor do those that only resolve an overlap.
/// @param problem  solved
/// @param memory   to work in
/// @return         their number
std::size_t find_unconstrained(const Problem& problem, std::span<const Servo> servos,
                               Workspace& work, UnconstrainedVelocities& memory,
                               std::vector<unsigned char>& out);

/// Clears the impulses of contacts between unconstrained trees.
/// @param free  see find_unconstrained()
void clear_contact_impulses(Problem& problem, std::span<const unsigned char> free);

/// Whether a servo's impulse is strictly within its bounds: then it reaches its target velocity.
inline bool is_unsaturated(const Servo& servo) {
  return servo.lower < servo.impulse && servo.impulse < servo.upper;
}

/// Prescribed joints of an island, with entries for each dof.
struct IslandPrescribedJoints {
  std::vector<unsigned char> has_servos;  ///< of each tree: whether it has servos along single dofs
  std::vector<unsigned char> prescribed;
  std::vector<double> velocity, force;
};

/// Finds the prescribed joints of a solved problem.
/// @param servos  of the problem's constraints, with their solved impulses
void find_prescribed_joints(const Problem& problem, std::span<const Servo> servos,
                            IslandPrescribedJoints& out);

/// Prescribed joints of a tree of the island.
PrescribedJoints prescribed_joints_of(const Problem& problem, std::size_t tree,
                                      const IslandPrescribedJoints& drives);

}  // namespace ziggurat::dynamics
