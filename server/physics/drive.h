#pragma once
// A body that is driven over the ground: its planar velocity and its turn rate are held to what
// is wanted, within a force and a torque.

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "scene/scene.h"

namespace ziggurat::physics {

/// Three rows for Bullet's solver: speed along the body's x axis, speed across it, turn rate about
/// the world's z. It acts at the centre of mass and leaves all else alone.
class Drive final : public btTypedConstraint {
 public:
  Drive(btRigidBody& body, const scene::Traction& traction);

  double velocity = 0;          ///< wanted, along the x axis [m/s]
  double angular_velocity = 0;  ///< wanted, about z [rad/s]
  bool turret_follows = true;   ///< the turret turns with the body
  double turret_speed = 0;      ///< else it turns by this more than the body is to turn [rad/s]
  double turret_angle = 0;      ///< in the body, (-pi, pi] [rad]

  /// Aims at the velocity that carries the body along its arc for a substep: the chord's, at the
  /// heading half way. So a circle closes however long substeps are.
  void before_substep(double length);
  /// Turns the turret as far as it turned while the body moved.
  void after_substep(double length);

  void getInfo1(btConstraintInfo1* info) override;
  void getInfo2(btConstraintInfo2* info) override;
  void setParam(int, btScalar, int) override {}
  btScalar getParam(int, int) const override { return 0; }

 private:
  scene::Traction traction_;
  btVector3 along_{1, 0, 0}, across_{0, 1, 0};  // unit, level
  double speed_ = 0;                            // of the coming substep, along [m/s]
  double length_ = 0;                           // of the coming substep [s]
};

}  // namespace ziggurat::physics
