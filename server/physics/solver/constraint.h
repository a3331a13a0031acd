// SPDX-License-Identifier: MIT
#pragma once
// Constraints of a substep: contacts, servos and limits. Each stores its impulse. Fed back,
// impulses start the next substep's solution, and keep bodies at rest from creeping.

#include <limits>
#include <span>
#include <vector>

#include "physics/multibody/spatial.h"

namespace ziggurat::dynamics {

/// A link of a tree of the system, or the world.
struct LinkIndex {
  int tree = -1;  ///< -1: the world
  int link = 0;
};

/// Speed of impacts below which there is no restitution [m/s].
inline constexpr double restitution_threshold = 0.05;

/// Gap below which surfaces touch from a substep's beginning on [m].
inline constexpr double touching_gap = 1e-6;

/// A point where two links touch or may touch within the substep.
struct ContactPoint {
  LinkIndex a, b;
  Vector3 point{0, 0, 0};  ///< in the world; on a, where both move and are apart [m]
  /// Offset from the point on a to that on b, where both move: they meet later in the substep [m].
  Vector3 offset_to_b{0, 0, 0};
  Vector3 normal{0, 0, 1};  ///< unit, from b to a
  /// Velocity of the point of contact where a round body touches a moving one [m/s]. It is the
  /// velocity of neither body's material.
  Vector3 point_velocity{0, 0, 0};
  bool has_point_velocity = false;  ///< it has that velocity
  Vector3 face_angular_velocity{0, 0,
                                0};  ///< of the other body, with which the normal turns [rad/s]
  double gap = 0;                    ///< along the normal; negative = overlap [m]
  double friction = 0;               ///< Coulomb coefficient
  double rolling_friction = 0;       ///< lever arm of rolling friction [m]
  double spinning_friction = 0;      ///< lever arm of spinning friction, about the normal [m]
  double restitution = 0;  ///< coefficient of restitution: separation over approach speed, 0 to 1
  bool carried = false;    ///< it had an impulse in the last substep
  /// Impulse on a in world axes. In: a first estimate, 0 if there is none. Out: of this substep.
  Vector3 impulse{0, 0, 0};          ///< [N s]
  Vector3 angular_impulse{0, 0, 0};  ///< of rolling and spinning friction [N m s]
};

/// A motor, a brake or a grip: a bounded impulse along one dof, along a direction at a link, or
/// between points of two links. It drives that speed to a target.
struct Servo {
  int tree = -1;
  int dof = -1;  ///< of the tree; -1: along `direction` at `link`
  int link = 0;
  Motion direction;             ///< world axes; the linear part at the link's centre of mass
  double target_velocity = 0;   ///< at the end of the substep [rad/s] or [m/s]
  double lower = 0, upper = 0;  ///< of the impulse [N m s] or [N s]; lower <= 0 <= upper
  double impulse = 0;           ///< in: a first estimate; out: of this substep
  /// Link of another tree that the opposite impulse acts on, if there is one: then the speed is
  /// that of `link` relative to it, where both are at `point`, and `direction` is linear.
  LinkIndex other;
  Vector3 point{0, 0, 0};  ///< in the world [m]
};

/// A bound of a revolute or prismatic joint.
struct Limit {
  int tree = -1;
  int link = 0;
  double lower = -std::numeric_limits<double>::infinity();  ///< [rad] or [m]
  double upper = std::numeric_limits<double>::infinity();
  double impulse = 0;  ///< in and out; > 0 at the lower bound, < 0 at the upper [N m s] or [N s]
};

/// The two trees of a contact; -1: the world. A ContactPoint takes far more of the cache.
struct ContactTrees {
  int a = -1, b = -1;
};
void list_contact_trees(std::span<const ContactPoint> contacts, std::vector<ContactTrees>& out);

/// Constraints of a step, in the caller's memory.
struct ConstraintLists {
  std::span<ContactPoint> contacts;
  std::span<Servo> servos;
  std::span<Limit> limits;
  std::vector<ContactTrees> contact_trees;  ///< of each contact
};

}  // namespace ziggurat::dynamics
