// SPDX-License-Identifier: MIT
#pragma once
// Motors and limits of joints with a coordinate, and servos of robots on wheels.

#include <cmath>
#include <optional>

#include "physics/bodies/bodies.h"
#include "physics/stepping/system.h"
#include "scene/scene.h"

namespace ziggurat::physics {

/// A revolute or prismatic joint.
struct CoordinateJoint {
  std::size_t entity = 0;
  std::size_t index = 0;  ///< into Entity::joints
  bool present = true;    ///< its entity was not removed
  std::size_t part = 0;   ///< that it moves
  std::optional<scene::JointLimit> limit;
  scene::JointMode mode = scene::JointMode::disabled;  ///< of its motor; disabled: none
  double max_impulse = 0;  ///< per substep of the scene [N s] or [N m s]
  double target = 0;

  double limit_impulse = 0, motor_impulse = 0;  ///< of the last substep [N s] or [N m s]
};

/// The servo of a motor for the coming substep, or a part of it.
/// @param length       of it [s]
/// @param left         from its beginning to the substep's end, when a target is to be reached [s]
/// @param impulse      its limit in that substep or part [N s] or [N m s]
/// @param is_factored  whether `work` has the factors of the tree's mass as it is now; in and out
dynamics::Servo servo_of(const CoordinateJoint& joint, const dynamics::Tree& tree,
                         dynamics::Workspace& work, double time_step, double left, double impulse,
                         bool& is_factored);

/// Servos that hold a body to its GroundMotion: velocity along and across, rate about the vertical.
/// @param impulses  of the last substep
std::array<dynamics::Servo, 3> servos_of(const Body& body, const std::array<double, 3>& impulses);

/// Fastest approach from which a motor of this strength can still stop at the target. With
/// deceleration a in steps of h, the distance is the sum of the remaining velocities.
/// @param distance  to the target [m or rad];  @param deceleration  [m/s^2 or rad/s^2], more than 0
/// @param length  of a substep [s]
/// @return  [m/s or rad/s]
inline double stoppable_velocity(double distance, double deceleration, double length) {
  const double step = deceleration * length;  // [m/s] lost per substep
  return step * (std::sqrt(0.25 + 2 * distance / (step * length)) - 0.5);
}

}  // namespace ziggurat::physics
