#pragma once
// What the caller tells of a substep: contacts, and forces along single coordinates that are not
// known beforehand. All of them remember their impulses: fed back in the next substep they are the
// start of the solution, and the memory of position that keeps what stands from creeping.

#include <limits>

#include "dynamics/spatial.h"

namespace ziggurat::dynamics {

/// A link of a tree of the system, or the world.
struct LinkIndex {
  int tree = -1;  ///< -1: the world
  int link = 0;
};

/// Slower impacts do not bounce, and where their surfaces are apart need not be known [m/s].
inline constexpr double restitution_threshold = 0.05;

/// Surfaces that are nearer touch from a substep's beginning on [m].
inline constexpr double touching_gap = 1e-6;

/// A point where two links touch or may touch within the substep.
struct ContactPoint {
  LinkIndex a, b;
  Vector3 point{0, 0, 0};   ///< in the world; on a, where both move and are apart [m]
  /// From the point on a to that on b, where both move: what meets later in the substep is not there yet [m].
  Vector3 offset_to_b{0, 0, 0};
  Vector3 normal{0, 0, 1};  ///< unit, from b to a
  /// Of a round body that touches another one that moves: the velocity of the point of contact, which is that of neither's material [m/s].
  Vector3 point_velocity{0, 0, 0};
  bool has_point_velocity = false;       ///< it has that velocity
  Vector3 face_angular_velocity{0, 0, 0};  ///< of the other body, with which the normal turns [rad/s]
  double gap = 0;           ///< along the normal; negative = overlap [m]
  double friction = 0;      ///< Coulomb coefficient
  double rolling_friction = 0;       ///< lever of the torque that resists rolling [m]
  double spinning_friction = 0;      ///< lever of the torque that resists turning about the normal [m]
  double restitution = 0;   ///< speed apart after an impact over speed together before it, 0 to 1
  /// In: what it gave in the last substep, 0 if it is new. Out: what it gives. On a; world axes.
  Vector3 impulse{0, 0, 0};          ///< [N s]
  Vector3 angular_impulse{0, 0, 0};  ///< of rolling and spinning friction [N m s]
};

/// A motor, a brake or a limit: an impulse along one freedom of a tree, or along a direction at a
/// link, that seeks a speed.
struct Servo {
  int tree = -1;
  int dof = -1;                ///< of the tree; -1: along `direction` at `link`
  int link = 0;
  Motion direction;            ///< world axes; the linear part at the link's centre of mass
  double target_velocity = 0;            ///< wanted at the end of the substep [rad/s] or [m/s]
  double lower = 0, upper = 0; ///< of the impulse [N m s] or [N s]; lower <= 0 <= upper
  double impulse = 0;          ///< in: of the last substep; out: of this one
};

/// A bound of a revolute or prismatic joint.
struct Limit {
  int tree = -1;
  int link = 0;
  double lower = -std::numeric_limits<double>::infinity();  ///< [rad] or [m]
  double upper = std::numeric_limits<double>::infinity();
  double impulse = 0;  ///< in and out; > 0 at the lower bound, < 0 at the upper [N m s] or [N s]
};

}  // namespace ziggurat::dynamics
