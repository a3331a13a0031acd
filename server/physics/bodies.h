#pragma once
// Our links as Bullet knows them.

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "math/pose.h"
#include "physics/contact/algorithm.h"
#include "scene/scene.h"

namespace ziggurat::physics {

/// A link: a rigid body, or one body of a multi-body.
struct LinkBody {
  btRigidBody* rigid = nullptr;
  btMultiBody* multi = nullptr;
  int index = -1;  ///< in the multi-body; -1 = its base
  bool moves = false;
  double mass = 0;
  math::Vector3 inertia{0, 0, 0};  ///< principal, link axes [kg m^2]
  math::Vector3 center_of_mass;    ///< in the bottom-centre frame [m]
  scene::Damping damping;
  math::Pose placed;               ///< X_WL as placed

  btTransform transform() const;  ///< of the centre of mass, link axes
  void apply_force(const btVector3& force) const;    ///< at the centre of mass [N]
  void apply_torque(const btVector3& torque) const;  ///< [N m]
};

struct Motion {
  btVector3 velocity{0, 0, 0};          ///< of the centre of mass, in the world [m/s]
  btVector3 angular_velocity{0, 0, 0};  ///< in the world [rad/s]
};

/// What an entity is made of in Bullet. Owns all of it.
struct Body {
  std::size_t entity = 0;
  std::size_t first_link = 0;     ///< its links' place in State::links
  std::vector<LinkBody> links;    ///< in the order of Entity::links
  std::size_t reference_link = 0;
  math::Pose origin_from_reference;  ///< X_LE: the entity's origin in the reference link
  math::Pose placed;                 ///< X_WE as placed

  std::unique_ptr<btRigidBody> rigid;
  std::unique_ptr<btMultiBody> multi;
  std::vector<std::unique_ptr<btCollisionShape>> shapes;
  std::vector<std::unique_ptr<contact::Collider>> colliders;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> link_colliders;

  /// Motion of every link, in the order of Entity::links.
  void motions(std::vector<Motion>& out) const;
};

/// Builds an entity's bodies where the entity stands. A box or cylinder becomes a rigid body,
/// everything else a multi-body with the reference link at its base.
Body build(const scene::Entity& entity);

}  // namespace ziggurat::physics
