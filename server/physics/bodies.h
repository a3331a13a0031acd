#pragma once
// Our links as Bullet knows them.

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "math/pose.h"
#include "physics/contact/algorithm.h"
#include "physics/drive.h"
#include "scene/scene.h"

namespace ziggurat::physics {

/// A link: a rigid body, one body of a multi-body, or what another link carries: a turning magnet,
/// or a frame of a robot on wheels.
struct LinkBody {
  btRigidBody* rigid = nullptr;
  btMultiBody* multi = nullptr;
  int index = -1;  ///< in the multi-body; -1 = its base
  bool moves = false;
  double mass = 0;
  math::Vector3 inertia{0, 0, 0};  ///< principal, link axes [kg m^2]
  math::Vector3 center_of_mass;    ///< in the bottom-centre frame [m]
  math::Vector3 half_extents;      ///< of the box about the shape, link axes [m]
  scene::Damping damping;
  math::Pose placed;  ///< X_WL as placed

  /// A sphere that turns freely about its centre is no body of its own: its mass moves with the
  /// link that carries it, its orientation is magnetism's affair (docs/magnetism.md). Frames have
  /// no mass at all.
  static constexpr int carries_itself = -1;
  int carrier = carries_itself;                          ///< index into Body::links
  btTransform in_carrier = btTransform::getIdentity();   ///< centre of mass in the carrier's
  math::Quaternion turn = math::Quaternion::Identity();  ///< since the start, in the carrier
  double spin = 0;  ///< of a turret, about the carrier's z [rad/s]

  btTransform transform() const;                     ///< of the centre of mass, link axes
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
  std::size_t first_link = 0;   ///< its links' place in State::links
  std::vector<LinkBody> links;  ///< in the order of Entity::links
  std::size_t reference_link = 0;
  math::Pose origin_from_reference;  ///< X_LE: the entity's origin in the reference link
  math::Pose placed;                 ///< X_WE as placed
  std::vector<scene::Magnet> magnets;

  std::unique_ptr<btRigidBody> rigid;
  std::unique_ptr<btMultiBody> multi;
  std::unique_ptr<Drive> drive;  ///< of a rigid body with traction
  std::optional<std::size_t> turret;  ///< into links
  std::vector<std::unique_ptr<btCollisionShape>> shapes;
  std::vector<std::unique_ptr<contact::Collider>> colliders;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> link_colliders;

  /// Motion of every link, in the order of Entity::links.
  void motions(std::vector<Motion>& out) const;
};

/// Builds an entity's bodies where the entity stands. A box, a cylinder, a robot on wheels, or a
/// prototype of one link without magnets becomes a rigid body, everything else a multi-body with
/// the reference link at its base.
/// @param physics  whether magnets act: then free spherical magnets are carried; what planes hold
Body build(const scene::Entity& entity, const scene::Physics& physics);

}  // namespace ziggurat::physics
