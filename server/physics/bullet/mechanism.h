#pragma once
// Mechanism of an entity in Bullet: one rigid body, or one multi-body.

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <memory>
#include <span>
#include <vector>

#include "physics/bodies.h"
#include "physics/bullet/ground_hold.h"
#include "physics/bullet/link_collider.h"
#include "physics/contact/algorithm.h"
#include "scene/scene.h"

namespace ziggurat::physics {

/// Either `rigid` or `multi`; the base of the multi-body is part 0, its link i is part i + 1.
struct Mechanism {
  std::unique_ptr<btRigidBody> rigid;
  std::unique_ptr<btMultiBody> multi;
  std::unique_ptr<GroundHold> hold;  ///< of a rigid body
  std::vector<std::unique_ptr<btCollisionShape>> shapes;
  std::vector<std::unique_ptr<contact::Collider>> colliders;
  std::vector<std::unique_ptr<LinkCollider>> link_colliders;  ///< of a multi-body

  btTransform transform(std::size_t part) const;
  void apply_force(std::size_t part, const btVector3& force);    ///< at the centre of mass [N]
  void apply_torque(std::size_t part, const btVector3& torque);  ///< [N m]
  void motions(std::span<Twist> out) const;
  bool sleeps() const;

  /// Brings the poses that Bullet caches up to date.
  void update_poses();

 private:
  // Memory that Bullet's functions work in, kept so that a substep allocates nothing.
  mutable btAlignedObjectArray<btVector3> omega_, velocity_;
  btAlignedObjectArray<btQuaternion> rotations_;
  btAlignedObjectArray<btVector3> positions_;
};

/// The number of a part in a multi-body; -1 is the base.
inline int multi_index(std::size_t part) { return static_cast<int>(part) - 1; }

/// Builds an entity where it stands. A box, a cylinder, a robot on wheels, or a prototype of one
/// link without magnets becomes a rigid body. Everything else becomes a multi-body with the
/// reference link in its base. Links on fixed joints are parts of what carries them.
/// @param physics  whether magnets act: then free spherical magnets are carried; what planes hold
/// @param entity_number  into State::origins
Body build(const scene::Entity& entity, const scene::Physics& physics, std::size_t entity_number);

}  // namespace ziggurat::physics
