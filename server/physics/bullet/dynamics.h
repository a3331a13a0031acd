#pragma once
// Bullet's multi-body world with bounding boxes as large as the reach of our contacts.

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <vector>

#include "physics/bullet/link_collider.h"

namespace ziggurat::physics {

class Dynamics final : public btMultiBodyDynamicsWorld {
 public:
  Dynamics(btDispatcher& dispatcher, btDbvtBroadphase& broadphase,
           btMultiBodyConstraintSolver& solver, btCollisionConfiguration& configuration);

  /// One step of exactly this length, with the forces applied since the last.
  void substep(btScalar length);

  /// Sets every moving collider's reach for the coming substep and its box accordingly.
  void updateAabbs() override;

  void addCollisionObject(btCollisionObject* object, int group, int mask) override;
  void removeCollisionObject(btCollisionObject* object) override;

  /// Without the poses that multi-bodies would reach if nothing stopped them: they are never read.
  void predictUnconstraintMotion(btScalar length) override;
  /// Moves bodies, and with them the colliders that Bullet does not know.
  void integrateTransforms(btScalar length) override;
  /// Colliders of one part are in one island.
  void calculateSimulationIslands() override;

 private:
  void keep_in_box(btBroadphaseProxy& proxy, const btVector3& low, const btVector3& high);

  btDbvtBroadphase& broadphase_;
  btScalar length_ = 0;                   ///< of the substep under way [s]
  std::vector<LinkCollider*> displaced_;  ///< those of our colliders
};

}  // namespace ziggurat::physics
