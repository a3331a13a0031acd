#pragma once
// Prescribed joints: servos that reach their target velocity in free motion.

#include <span>
#include <vector>

#include "dynamics/problem.h"

namespace ziggurat::dynamics {

/// Whether a servo's impulse is strictly within its bounds: then it reaches its target velocity.
inline bool is_unsaturated(const Servo& servo) { return servo.lower < servo.impulse && servo.impulse < servo.upper; }

/// Prescribed joints of an island, with entries for each dof.
struct IslandPrescribedJoints {
  std::vector<unsigned char> has_servos;  ///< of each tree: whether it has servos along single dofs
  std::vector<unsigned char> prescribed;
  std::vector<double> velocity, force;
};

/// Finds the prescribed joints of a solved problem.
/// @param servos  of the problem's constraints, with their solved impulses
void find_prescribed_joints(const Problem& problem, std::span<const Servo> servos, IslandPrescribedJoints& out);

/// Prescribed joints of a tree of the island.
PrescribedJoints prescribed_joints_of(const Problem& problem, std::size_t tree, const IslandPrescribedJoints& drives);

}  // namespace ziggurat::dynamics
