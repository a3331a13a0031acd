#include "physics/drive.h"

#include <cmath>
#include <numbers>

namespace ziggurat::physics {

Drive::Drive(btRigidBody& body, const scene::Traction& traction)
    : btTypedConstraint(CONTACT_CONSTRAINT_TYPE, body), traction_(traction) {}

void Drive::before_substep(double length) {
  const double half = angular_velocity * length / 2;
  speed_ = velocity * (std::abs(half) < 1e-4 ? 1 - half * half / 6 : std::sin(half) / half);
  length_ = length;
  const btVector3 x = m_rbA.getWorldTransform().getBasis().getColumn(0);
  const double heading = std::atan2(x.y(), x.x()) + half;
  along_.setValue(std::cos(heading), std::sin(heading), 0);
  across_.setValue(-along_.y(), along_.x(), 0);
}

void Drive::after_substep(double length) {
  if (turret_follows) return;
  const double turned = (angular_velocity + turret_speed - m_rbA.getAngularVelocity().z()) * length;
  turret_angle = std::remainder(turret_angle + turned, 2 * std::numbers::pi);
}

void Drive::getInfo1(btConstraintInfo1* info) {
  info->m_numConstraintRows = 3;
  info->nub = 3;
}

void Drive::getInfo2(btConstraintInfo2* info) {
  const btVector3* directions[] = {&along_, &across_};
  const btScalar wanted[] = {speed_, 0, angular_velocity};
  for (int row = 0; row < 3; ++row) {
    const int place = row * info->rowskip;
    for (int axis = 0; axis < 3 && row < 2; ++axis) {
      info->m_J1linearAxis[place + axis] = (*directions[row])[axis];
    }
    if (row == 2) info->m_J1angularAxis[place + 2] = 1;
    const btScalar most = (row < 2 ? traction_.max_force : traction_.max_torque) * length_;
    info->m_constraintError[place] = wanted[row];
    info->m_lowerLimit[place] = -most;
    info->m_upperLimit[place] = most;
  }
}

}  // namespace ziggurat::physics
