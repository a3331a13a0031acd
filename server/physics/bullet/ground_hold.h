#pragma once
// Three rows for Bullet's solver that hold a body to its GroundMotion: speed along its direction,
// speed across it, turn rate about the world's z. They act at the centre of mass and leave all
// else alone.

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "physics/bodies.h"

namespace ziggurat::physics {

class GroundHold final : public btTypedConstraint {
 public:
  explicit GroundHold(btRigidBody& body) : btTypedConstraint(CONTACT_CONSTRAINT_TYPE, body) {}

  /// Takes what the coming substep is to hold.
  void set(const GroundMotion& motion) { motion_ = motion; }

  void getInfo1(btConstraintInfo1* info) override;
  void getInfo2(btConstraintInfo2* info) override;
  void setParam(int, btScalar, int) override {}
  btScalar getParam(int, int) const override { return 0; }

 private:
  GroundMotion motion_;
};

}  // namespace ziggurat::physics
