#include "physics/bullet/joints.h"

#include <algorithm>
#include <cmath>

namespace ziggurat::physics {
namespace {

/// How much velocity a unit impulse on the joint gives it [1/kg] or [1/(kg m^2)]; 0 if unknown
/// (before the first substep).
double mobility(MovingJoint& joint) {
  btMultiBody& multi = *joint.multi;
  auto& [impulse, response, scalars, vectors] = joint.scratch;
  impulse.resize(6 + multi.getNumDofs(), 0);
  response.resize(6 + multi.getNumDofs(), 0);
  const int dof = 6 + multi.getLink(joint.link).m_dofOffset;
  impulse[dof] = 1;
  multi.calcAccelerationDeltasMultiDof(&impulse[0], &response[0], scalars, vectors);
  return std::isfinite(response[dof]) ? response[dof] : 0;
}

/// The fastest approach from which a motor of this strength can still stop at the target:
/// with deceleration a in steps of h, the sum of the velocities left to go is the distance.
double stoppable_velocity(double distance, double deceleration, double length) {
  const double step = deceleration * length;  // [m/s] lost per substep
  return step * (std::sqrt(0.25 + 2 * distance / (step * length)) - 0.5);
}

}  // namespace

void steer(MovingJoint& joint, double length, double impulse) {
  Motor& motor = joint.motor;
  double velocity = motor.target;
  if (motor.mode == scene::JointMode::position) {
    const double error = motor.target - joint.multi->getJointPos(joint.link);
    velocity = error / length;
    // Half the strength for braking leaves the other half for gravity and other loads.
    const double deceleration = 0.5 * impulse * mobility(joint) / length;
    if (deceleration > 0) {
      const double most = stoppable_velocity(std::abs(error), deceleration, length);
      velocity = std::clamp(velocity, -most, most);
    }
  }
  motor.constraint->setVelocityTarget(velocity, 1);
  motor.constraint->setMaxAppliedImpulse(impulse);
}

}  // namespace ziggurat::physics
