#pragma once
// Our links as Bullet knows them.

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "math/pose.h"
#include "physics/contact/algorithm.h"
#include "physics/drive.h"
#include "physics/link_collider.h"
#include "scene/scene.h"

namespace ziggurat::physics {

/// What moves as one: a rigid body, or the base or a link of a multi-body. Its frame is at the
/// centre of mass, along principal axes.
struct Part {
  btRigidBody* rigid = nullptr;
  btMultiBody* multi = nullptr;
  int index = -1;  ///< in the multi-body; -1 = its base
  bool moves = false;
  double mass = 0;
  math::Vector3 inertia{0, 0, 0};  ///< principal [kg m^2]

  btTransform transform() const;
  void apply_force(const btVector3& force) const;    ///< at the centre of mass [N]
  void apply_torque(const btVector3& torque) const;  ///< [N m]
};

/// A link of the scene, and where it sits in its part: alone, welded to others, or carried.
struct LinkBody {
  bool moves = false;
  double mass = 0;
  math::Vector3 inertia{0, 0, 0};  ///< principal, link axes [kg m^2]
  math::Vector3 center_of_mass;    ///< of the link alone, in the bottom-centre frame [m]
  math::Vector3 half_extents;      ///< of the box about the shape, link axes [m]
  scene::Damping damping;
  math::Pose placed;  ///< X_WL as placed

  std::size_t part = 0;                                  ///< into Body::parts
  math::Pose in_part;                                    ///< the link's centre of mass and axes
  math::Quaternion turn = math::Quaternion::Identity();  ///< since the start, in the part
  double spin = 0;  ///< of a turret, about the part's z [rad/s]

  /// A sphere that turns freely about its centre is no body of its own: its mass moves with the
  /// link that carries it, its orientation is magnetism's affair (docs/magnetism.md).
  static constexpr int carries_itself = -1;
  int carrier = carries_itself;  ///< index into Body::links

  math::Pose frame_in_part() const;  ///< X_PL of the bottom-centre frame at the start
};

struct Motion {
  btVector3 velocity{0, 0, 0};          ///< of the centre of mass, in the world [m/s]
  btVector3 angular_velocity{0, 0, 0};  ///< in the world [rad/s]
};

/// What an entity is made of in Bullet. Owns all of it.
struct Body {
  std::size_t entity = 0;
  std::size_t first_link = 0;   ///< its links' place in State::links
  std::vector<Part> parts;      ///< that of the reference link first
  std::vector<LinkBody> links;  ///< in the order of Entity::links
  std::size_t reference_link = 0;
  math::Pose origin_from_reference;  ///< X_LE: the entity's origin in the reference link
  math::Pose placed;                 ///< X_WE as placed
  std::vector<scene::Magnet> magnets;

  std::unique_ptr<btRigidBody> rigid;
  std::unique_ptr<btMultiBody> multi;
  std::unique_ptr<Drive> drive;       ///< of a rigid body with traction
  std::optional<std::size_t> turret;  ///< into links
  std::vector<std::unique_ptr<btCollisionShape>> shapes;
  std::vector<std::unique_ptr<contact::Collider>> colliders;
  std::vector<std::unique_ptr<LinkCollider>> link_colliders;

  /// Of a link's centre of mass, link axes.
  btTransform transform(const LinkBody& link) const;
  /// Motion of every part.
  void motions(std::vector<Motion>& out) const;
  /// Motion of a link.
  /// @param parts  of every part
  Motion motion(const LinkBody& link, std::span<const Motion> parts) const;
};

/// X_WP of the reference link's part as placed.
math::Pose base_pose(const Body& body);

/// Builds an entity's bodies where the entity stands. A box, a cylinder, a robot on wheels, or a
/// prototype of one link without magnets becomes a rigid body, everything else a multi-body with
/// the reference link in its base. Links on fixed joints are parts of what carries them.
/// @param physics  whether magnets act: then free spherical magnets are carried; what planes hold
Body build(const scene::Entity& entity, const scene::Physics& physics);

}  // namespace ziggurat::physics
