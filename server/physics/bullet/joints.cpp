#include "physics/bullet/joints.h"

#include <algorithm>
#include <cmath>

#include "physics/braking.h"

namespace ziggurat::physics {
namespace {

/// Velocity change by a unit impulse on the joint [1/kg] or [1/(kg m^2)]; 0 if unknown (before the
/// first substep).
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
