#pragma once
// What two colliders do to each other when they fly freely for a substep: they meet, or pass.

#include "physics/newton/colliders.h"

namespace ziggurat::physics {

/// The points where two colliders that are apart first meet within a substep, as they are at its
/// beginning: each at its distance along the normal of the meeting. None if they pass each other.
/// Conservative advancement (B. Mirtich, Impulse-based Dynamic Simulation, 1996, section 2.3).
/// Round surfaces are followed to where they touch, or are nearest: there the normal turns with the
/// way that is left.
/// @param near  counts as met [m]
/// @param time  out: when, from the substep's beginning [s]
contact::Manifold time_of_impact(const Collider& a, const Collider& b, double time_step, double near,
                                double& time);

/// How far a collider that swings turns in a time [rad]; 0 of others.
double arm_rotation(const Collider& collider, double time);

/// Whether the normal of such a contact turns while two colliders come together: one of them is
/// round, and the other no plane.
bool has_rotating_normal(const Collider& a, const Collider& b);

/// Whether two colliders rebound from each other with the levers of the touch: single bodies. Of
/// jointed ones all levers would change.
bool rebounds_at_touch_pose(const Collider& a, const Collider& b);

}  // namespace ziggurat::physics
