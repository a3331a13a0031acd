#pragma once
// What two colliders do to each other when they fly freely for a substep: they meet, or pass.

#include "physics/newton/colliders.h"

namespace ziggurat::physics {

/// The points where two colliders that are apart first meet within a substep, as they are at its
/// beginning: each at its distance along the normal of the meeting. None if they pass each other.
/// Conservative advancement (B. Mirtich, Impulse-based Dynamic Simulation, 1996, section 2.3).
/// @param near  counts as met [m]
contact::Contacts first_meeting(const Collider& a, const Collider& b, double length, double near);

}  // namespace ziggurat::physics
