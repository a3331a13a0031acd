#pragma once
// Flight of what motors of joints drive.

#include <span>
#include <vector>

#include "dynamics/problem.h"

namespace ziggurat::dynamics {

/// Whether a servo does not give all that it has: then its speed is what it seeks.
inline bool is_obeyed(const Servo& servo) { return servo.lower < servo.impulse && servo.impulse < servo.upper; }

/// Memory of fly_driven(), which it uses again: see Drive, of each dof of an island.
struct Drives {
  std::vector<unsigned char> driven;  ///< of each tree: whether it has servos
  std::vector<unsigned char> held;
  std::vector<double> speed, push;
};

/// Flies the trees of an island in which nothing acts but servos along single dofs; its problem is solved, which tells which of
/// them hold speeds.
/// @param servos  of the problem's blocks, with the impulses of its solution
void fly_driven(const Problem& problem, std::span<const Servo> servos, Workspace& work, Drives& memory);

}  // namespace ziggurat::dynamics
