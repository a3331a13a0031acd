#pragma once
// Time of impact of two colliders in free motion for a substep.

#include "physics/newton/colliders.h"

namespace ziggurat::physics {

/// Finds the points where two separate colliders first meet within a substep, each with its
/// distance along the normal at the impact. None if they pass each other. The method is
/// conservative advancement (B. Mirtich, Impulse-based Dynamic Simulation, 1996, section 2.3).
/// Round surfaces are followed to their touch or closest approach, because their normal rotates.
/// @param near  distance that counts as an impact [m]
/// @param time  out: of the impact, from the substep's beginning [s]
contact::Manifold time_of_impact(const Collider& a, const Collider& b, double time_step, double near,
                                double& time);

/// Rotation of a collider on a fixed base in a time [rad]; 0 of others.
double arm_rotation(const Collider& collider, double time);

/// Whether the normal of a contact rotates while two colliders approach: one of them is round, and
/// the other no plane.
bool has_rotating_normal(const Collider& a, const Collider& b);

/// Whether an impact of two colliders uses the levers of the touch: single bodies. Of jointed ones
/// all levers would change.
bool rebounds_at_touch_pose(const Collider& a, const Collider& b);

}  // namespace ziggurat::physics
