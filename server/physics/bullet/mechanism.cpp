#include "physics/bullet/mechanism.h"

namespace ziggurat::physics {

btTransform Mechanism::transform(std::size_t part) const {
  if (rigid) return rigid->getWorldTransform();
  if (part == 0) return multi->getBaseWorldTransform();
  // Bullet moves colliders with each substep, the cached pose only when the next one begins.
  const btMultibodyLink& link = multi->getLink(multi_index(part));
  return link.m_collider ? link_collider(link.m_collider)->part() : link.m_cachedWorldTransform;
}

void Mechanism::apply_force(std::size_t part, const btVector3& force) {
  if (rigid) {
    rigid->applyCentralForce(force);
  } else if (part == 0) {
    multi->addBaseForce(force);
  } else {
    multi->addLinkForce(multi_index(part), force);
  }
}

void Mechanism::apply_torque(std::size_t part, const btVector3& torque) {
  if (rigid) {
    rigid->applyTorque(torque);
  } else if (part == 0) {
    multi->addBaseTorque(torque);
  } else {
    multi->addLinkTorque(multi_index(part), torque);
  }
}

void Mechanism::motions(std::span<Twist> out) const {
  if (rigid) {
    out[0] = {rigid->getLinearVelocity(), rigid->getAngularVelocity()};
    return;
  }
  // Bullet's tree velocities come in each link's own frame, the base first.
  const int count = multi->getNumLinks() + 1;
  omega_.resize(count, btVector3(0, 0, 0));
  velocity_.resize(count, btVector3(0, 0, 0));
  multi->compTreeLinkVelocities(&omega_[0], &velocity_[0]);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const btMatrix3x3 basis = transform(i).getBasis();
    const int number = static_cast<int>(i);
    out[i] = {basis * velocity_[number], basis * omega_[number]};
  }
}

bool Mechanism::sleeps() const { return rigid && !rigid->isActive(); }

void Mechanism::update_poses() {
  if (multi) multi->forwardKinematics(rotations_, positions_);
}

}  // namespace ziggurat::physics
