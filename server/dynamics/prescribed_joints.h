#pragma once
// Flight of what motors of joints drive.

#include <span>
#include <vector>

#include "dynamics/problem.h"

namespace ziggurat::dynamics {

/// Whether a servo does not give all that it has: then its speed is what it seeks.
inline bool is_unsaturated(const Servo& servo) { return servo.lower < servo.impulse && servo.impulse < servo.upper; }

/// See Drive, of each dof of an island.
struct IslandPrescribedJoints {
  std::vector<unsigned char> has_servos;  ///< of each tree: whether it has servos along single dofs
  std::vector<unsigned char> prescribed;
  std::vector<double> velocity, force;
};

/// @param servos  of the problem's blocks, with the impulses of its solution, which tells which of them hold speeds
void find_prescribed_joints(const Problem& problem, std::span<const Servo> servos, IslandPrescribedJoints& out);

/// That of a tree of the island.
PrescribedJoints prescribed_joints_of(const Problem& problem, std::size_t tree, const IslandPrescribedJoints& drives);

}  // namespace ziggurat::dynamics
