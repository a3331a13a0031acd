// SPDX-License-Identifier: MIT
#pragma once
// Small values that World and its core give and take.

#include <cstddef>

#include "math/pose.h"

namespace ziggurat::math {
class Archive;
}

namespace ziggurat::physics {

/// A joint with a coordinate, as the world counts them.
struct JointIndex {
  std::size_t value = 0;
};

/// Aim of a flying body.
struct FlightTarget {
  void archive(math::Archive& archive);

  bool holds_position = true;                      ///< otherwise it flies at `velocity`
  math::Vector3 position = math::Vector3::Zero();  ///< of the entity's origin, in W [m]
  math::Vector3 velocity = math::Vector3::Zero();  ///< along its heading, to its left, up [m/s]
  bool holds_heading = true;                       ///< otherwise it turns at `turn_rate`
  double heading = 0;                              ///< about z of W [rad]
  double turn_rate = 0;                            ///< [rad/s]
};

/// Contacts of a link since the last request.
struct LinkTouch {
  bool touched = false;                           ///< in a substep at least
  math::Vector3 impulse = math::Vector3::Zero();  ///< the sum on the link, in W [N s]
  double magnitude = 0;  ///< of each contact and substep, their sum [N s]: where contacts press
                         ///< against each other, `impulse` is less
};

/// Gripper at the front of a robot's turret, or of the robot: an upright cylinder from its floor
/// on.
struct Gripper {
  double distance = 0;            ///< of its axis from the robot's [m]
  double radius = 0, height = 0;  ///< [m]
  double max_force = 0;           ///< with which it holds [N]
};

/// Convergence of the contact solver since the world began.
struct Convergence {
  std::size_t islands = 0;        ///< solved, over all substeps
  std::size_t not_converged = 0;  ///< of them
  double worst = 0;               ///< violation of the laws of contacts and motors [m/s], [rad/s]
  std::size_t divided = 0;        ///< substeps that something took in `many_parts` or more
  std::size_t divided_entity =
      0;  ///< in order of adding: the first such, or of several the one of most links
};
/// A substep in so many parts, or so many evaluations of a tree's equations of motion, takes as
/// many times longer.
constexpr int many_parts = 100;

}  // namespace ziggurat::physics
