// SPDX-License-Identifier: MIT
#pragma once
// Collides two colliders, with the motions that they have in a substep.

#include "physics/collision/colliders.h"

namespace ziggurat::physics {

/// Rotation of two colliders in a substep.
struct RotationOutcome {
  bool tumbles = false;              ///< one so far that other points may touch
  bool may_overlap = false;          ///< no contact, but rotation may bring one
  double rotation_until_impact = 0;  ///< of one on a fixed base, until the impact [rad]
};

/// Collides two colliders: points that may touch within the substep.
/// @param slack        gap that counts as close [m]
/// @param most_points  of those that tumble
contact::Manifold collide(const Collider& a, const Collider& b, double time_step, double slack,
                          int most_points, RotationOutcome& out);

/// Collides two colliders with their predicted motions.
/// @param a, b  into Colliders::all
contact::Manifold collide_predicted(const Colliders& colliders, std::size_t a, std::size_t b,
                                    double time_step, double slack, int most_points,
                                    RotationOutcome& out);

}  // namespace ziggurat::physics
