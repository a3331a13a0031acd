// SPDX-License-Identifier: MIT
#pragma once
// Whether colliders overlap where they are placed.

#include <cstddef>
#include <vector>

#include "physics/collision/shapes.h"
#include "scene/scene.h"

namespace ziggurat::physics {

struct PlacedCollider {
  contact::Shape shape;
  btTransform pose;  ///< of the shape's centre, in the world
};

/// Colliders of an entity at a pose of its origin, joints as assembled.
std::vector<PlacedCollider> placed_colliders(const scene::Entity& entity, const math::Pose& pose);

/// Penetration that placed bodies may have: rounding is a thousand times smaller [m].
constexpr double placed_depth = 1e-8;
/// Penetration that resting bodies may have [m].
constexpr double resting_depth = 1e-4;

/// Touching is not overlapping. @param depth  up to which they touch [m]
bool overlaps(const PlacedCollider& a, const PlacedCollider& b, double depth);

/// No entity.
constexpr std::size_t no_entity = static_cast<std::size_t>(-1);

}  // namespace ziggurat::physics
