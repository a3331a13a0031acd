#pragma once
// Joints with a coordinate: limits and motors.

#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>

#include <memory>

#include "scene/scene.h"

namespace ziggurat::physics {

struct Motor {
  scene::JointMode mode = scene::JointMode::disabled;
  double max_impulse = 0;  ///< per substep of the scene [N s] or [N m s]
  double target = 0;
  std::unique_ptr<btMultiBodyJointMotor> constraint;
};

/// A revolute or prismatic joint.
struct MovingJoint {
  std::size_t entity = 0;
  std::size_t index = 0;  ///< into Entity::joints
  btMultiBody* multi = nullptr;
  int link = 0;  ///< the multi-body's number of the child link
  std::unique_ptr<btMultiBodyJointLimitConstraint> limit;
  Motor motor;

  /// Memory of steer(), kept so that a substep allocates nothing.
  struct Scratch {
    btAlignedObjectArray<btScalar> impulse, response, scalars;
    btAlignedObjectArray<btVector3> vectors;
  } scratch;
};

/// Sets the velocity that a motor must reach at the end of the coming substep.
/// @param length     of the (internal) substep [s]
/// @param impulse    its limit in that substep [N s] or [N m s]
void steer(MovingJoint& joint, double length, double impulse);

}  // namespace ziggurat::physics
