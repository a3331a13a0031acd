// SPDX-License-Identifier: MIT
#include "physics/motors.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "physics/bodies/convert.h"
#include "physics/build.h"

namespace ziggurat::physics {
namespace {

/// Target velocity of a position motor.
double approach(double error, const dynamics::Tree& tree, dynamics::Workspace& work, int dof,
                double time_step, double left, double impulse, bool& is_factored) {
  const double velocity = error / left;
  if (impulse == 0 || error == 0) return velocity;
  if (!std::exchange(is_factored, true)) {
    compute_mass_matrix(tree, work);
    factor_mass_matrix(tree, work, time_step);
  }
  // Half the strength for braking leaves the other half for gravity and other loads.
  const double deceleration = 0.5 * impulse * mobility(tree, work, dof) / time_step;
  const double most = stoppable_velocity(std::abs(error), deceleration, time_step);
  return std::clamp(velocity, -most, most);
}

}  // namespace

dynamics::Servo servo_of(const CoordinateJoint& joint, const dynamics::Tree& tree,
                         dynamics::Workspace& work, double time_step, double left, double impulse,
                         bool& is_factored) {
  dynamics::Servo servo;
  servo.tree = static_cast<int>(joint.entity);
  servo.dof = dof_of(tree, joint.part);
  servo.target_velocity = joint.target;
  if (joint.mode == scene::JointMode::position) {
    const double error = joint.target - tree.q[position_of(tree, joint.part)];
    servo.target_velocity =
        approach(error, tree, work, servo.dof, time_step, left, impulse, is_factored);
  }
  servo.lower = -impulse;
  servo.upper = impulse;
  servo.impulse = joint.motor_impulse;
  return servo;
}

std::array<dynamics::Servo, 3> servos_of(const Body& body, const std::array<double, 3>& impulses) {
  const GroundMotion& ground = *body.ground;
  std::array<dynamics::Servo, 3> servos;
  for (int i = 0; i < 3; ++i) {
    servos[i].tree = static_cast<int>(body.entity);
    servos[i].upper =
        (i < 2 ? ground.limits.max_force : ground.limits.max_torque) * ground.time_step;
    servos[i].lower = -servos[i].upper;
    servos[i].impulse = impulses[i];
  }
  servos[0].direction.linear = from_bullet(ground.along);
  servos[0].target_velocity = ground.speed;
  servos[1].direction.linear = from_bullet(ground.across);
  servos[2].direction.angular = {0, 0, 1};
  servos[2].target_velocity = ground.angular_velocity;
  return servos;
}

}  // namespace ziggurat::physics
