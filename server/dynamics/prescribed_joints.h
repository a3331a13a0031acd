#pragma once
// Flight of what motors of joints drive.

#include <span>
#include <vector>

#include "dynamics/problem.h"

namespace ziggurat::dynamics {

/// Whether a servo does not give all that it has: then its speed is what it seeks.
inline bool is_obeyed(const Servo& servo) { return servo.lower < servo.impulse && servo.impulse < servo.upper; }

/// See Drive, of each dof of an island.
struct Drives {
  std::vector<unsigned char> driven;  ///< of each tree: whether it has servos along single dofs
  std::vector<unsigned char> held;
  std::vector<double> speed, push;
};

/// @param servos  of the problem's blocks, with the impulses of its solution, which tells which of them hold speeds
void find_drives(const Problem& problem, std::span<const Servo> servos, Drives& out);

/// That of a tree of the island.
Drive drive_of(const Problem& problem, std::size_t tree, const Drives& drives);

}  // namespace ziggurat::dynamics
