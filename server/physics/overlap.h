#pragma once
// Whether colliders overlap where they are placed.

#include <vector>

#include "physics/contact/shapes.h"
#include "scene/scene.h"

namespace ziggurat::physics {

struct PlacedCollider {
  contact::Shape shape;
  btTransform pose;  ///< of the shape's centre, in the world
};

/// Those of an entity at its pose, joints as assembled.
std::vector<PlacedCollider> placed_colliders(const scene::Entity& entity);

/// Touching is not overlapping.
bool overlaps(const PlacedCollider& a, const PlacedCollider& b);

}  // namespace ziggurat::physics
