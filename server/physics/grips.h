// SPDX-License-Identifier: MIT
#pragma once
// Grips: what the grippers of robots on wheels hold. A grip holds a point of another entity to a
// point of the robot's turret, with a limited force. It lets it turn about that point.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "physics/bodies/bodies.h"
#include "physics/collision/colliders.h"
#include "physics/stepping/system.h"

namespace ziggurat::physics {

struct Grip {
  std::size_t entity = 0;            ///< that grips
  std::size_t held = 0, part = 0;    ///< what it holds: into all bodies, into Body::parts
  math::Vector3 point{0, 0, 0};      ///< that is held, in the part [m]
  double distance = 0, height = 0;   ///< where it is held: from the centre of the robot's body
                                     ///< outward and up [m]
  double bearing = 0;                ///< likewise, from the turret's front [rad]
  double max_force = 0;              ///< [N]
  double spin = 0;                   ///< of the turret in the last substep [rad/s]
  bool is_torn = false;              ///< its force was too large: it holds nothing any more
  std::array<double, 3> impulses{};  ///< of the last substep: outward, across, up [N s]

  void archive(math::Archive& archive);
};

/// The grip on the nearest point within reach of a gripper, which points where the robot's turret
/// does; none if nothing there can be gripped.
/// @param robot  with a ground motion
std::optional<Grip> find_grip(const Body& robot, const Gripper& gripper,
                              std::span<const Body> bodies, const Colliders& colliders,
                              const dynamics::System& system);

/// Servos of a grip for the coming substep, in the order of its impulses. A turret that follows its
/// robot does not hold what is gripped across: it turns with it.
/// @param time_step  of the substep, or a part of it [s]
std::array<dynamics::Servo, 3> servos_of(const Grip& grip, std::span<const Body> bodies,
                                         double time_step);

/// Whether the turret's command has changed since the last substep.
bool is_commanded_anew(const Grip& grip, std::span<const Body> bodies);

/// Tears a grip whose impulses reached their limit, and turns a turret that follows its robot to
/// what it holds. To be called after a substep.
void end_substep(Grip& grip, std::span<Body> bodies);

}  // namespace ziggurat::physics
