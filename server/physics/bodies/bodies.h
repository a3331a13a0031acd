// SPDX-License-Identifier: MIT
#pragma once
// An entity as plug-ins see it: its links, and the parts that move as one. The core (newton/)
// moves the parts; here it is only asked where they are and pushed.

#include <LinearMath/btTransform.h>

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "math/pose.h"
#include "physics/bodies/articulation.h"
#include "physics/bodies/values.h"
#include "scene/scene.h"

namespace ziggurat::math {
class Archive;
}

namespace ziggurat::physics {

/// A rigid part. Its frame is at the centre of mass, along principal axes.
struct Part {
  bool moves = false;
  double mass = 0;
  math::Vector3 inertia{0, 0, 0};  ///< principal [kg m^2]
};

/// A link of the scene, and where it sits in its part: alone, welded to others, or carried.
struct LinkBody {
  void archive(math::Archive& archive);  ///< what changes

  bool moves = false;
  double mass = 0;
  math::Vector3 inertia{0, 0, 0};  ///< principal [kg m^2]
  math::Pose center;               ///< X_LS: the link's own centre of mass and principal axes
  /// Half extents of the box about the shape and S's origin, S's axes [m].
  math::Vector3 half_extents = math::Vector3::Zero();
  scene::Damping damping;
  math::Pose placed;  ///< X_WL as placed

  std::size_t part = 0;                                  ///< into Body::parts
  math::Pose in_part;                                    ///< X_PS of the link's `center`
  math::Quaternion turn = math::Quaternion::Identity();  ///< since the start, in the part
  double spin = 0;                 ///< of a turret, about the part's z [rad/s]
  std::optional<LinkTouch> touch;  ///< of a link whose contacts are watched

  /// A sphere that turns freely about its centre is no body of its own. Its mass moves with the
  /// link that carries it; magnetism sets its orientation (docs/magnetism.md).
  static constexpr int carries_itself = -1;
  int carrier = carries_itself;  ///< index into Body::links

  math::Pose frame_in_part() const;  ///< X_PL at the start
};

/// A body on the ground whose planar velocity and turn rate the core drives to targets, within a
/// force and a torque.
struct GroundMotion {
  scene::Traction limits;
  double velocity = 0;          ///< wanted, along the body's x axis [m/s]
  double angular_velocity = 0;  ///< wanted, about the world's z [rad/s]

  // State of the coming substep:
  btVector3 along{1, 0, 0}, across{0, 1, 0};  ///< unit, level
  double speed = 0;                           ///< wanted along `along` [m/s]; 0 across
  double time_step = 0;                       ///< of the substep [s]
};

/// A frame on top of a robot that turns about the robot's z axis.
struct Turret {
  std::size_t link = 0;  ///< into Body::links
  bool follows = true;   ///< it turns with the robot
  double speed = 0;      ///< otherwise: faster than the robot is to turn, by so much [rad/s]
  double angle = 0;      ///< in the robot, [-pi, pi] [rad]
};

/// A body that flies, upright, to a target.
struct FlyingBody {
  scene::Flight limits;
  FlightTarget target;
};

struct Magnet {
  scene::Magnet scene;
  /// Radius of the ball about its centre that no magnet of another entity can enter, because
  /// colliders are in between; 0: none [m].
  double core = 0;
  double current = 0;  ///< times the active field
};

/// An entity in the world. A removed one has no links and no parts.
struct Body {
  std::size_t entity = 0;
  std::size_t first_link = 0;   ///< its links' place in State::links
  std::vector<Part> parts;      ///< that of the reference link first
  std::vector<LinkBody> links;  ///< in the order of Entity::links
  std::size_t reference_link = 0;
  math::Pose origin_from_reference;  ///< X_LE: the entity's origin in the reference link
  math::Pose placed;                 ///< X_WE as placed
  std::size_t first_magnet = 0;      ///< its magnets' place among those of all entities
  std::vector<Magnet> magnets;
  std::optional<GroundMotion> ground;  ///< robots on wheels, and bodies on a plane
  std::optional<Turret> turret;
  std::optional<FlyingBody> flight;
  bool is_grippable = false;     ///< grippers may hold it
  bool carries_magnets = false;  ///< spheres that turn freely

  std::optional<Articulation> articulation;  ///< in the core; none: it was removed

  void archive(math::Archive& archive);  ///< what changes, but for what the core moves

  /// X_WP of a part.
  btTransform transform(std::size_t part) const;
  /// X_WS of a link's centre of mass and principal axes.
  btTransform transform(const LinkBody& link) const;
  void apply_force(std::size_t part, const btVector3& force);    ///< at the centre of mass [N]
  void apply_torque(std::size_t part, const btVector3& torque);  ///< [N m]
  bool sleeps() const;  ///< at rest until something touches or pushes it
  /// Whether a turret or a magnet of it may turn while it sleeps.
  bool turns_asleep() const { return turret.has_value() || carries_magnets; }

  /// Motion of every part.
  void motions(std::vector<Twist>& out) const;
  /// Motion of a link.
  /// @param parts  of every part
  Twist motion(const LinkBody& link, std::span<const Twist> parts) const;
};

/// X_WP of the reference link's part as placed.
math::Pose base_pose(const Body& body);

/// X_EL of every link with all joint coordinates at zero, in the order of Entity::links.
std::vector<math::Pose> assemble(const scene::Entity& entity);

}  // namespace ziggurat::physics
