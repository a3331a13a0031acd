#pragma once
// The floor: the half-space z <= 0, unbounded.

#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include "physics/plugin.h"

namespace ziggurat::physics {

class Floor final : public Plugin {
 public:
  Floor(const scene::Floor& floor, btMultiBodyDynamicsWorld& world);
  ~Floor() override;
  Floor(const Floor&) = delete;
  Floor& operator=(const Floor&) = delete;

  void before_substep(std::span<Body>, double) override {}

 private:
  btMultiBodyDynamicsWorld& world_;
  btStaticPlaneShape plane_;
  contact::Collider collider_;
  btRigidBody body_;
};

}  // namespace ziggurat::physics
