#pragma once
// Whether colliders overlap where they are placed.

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <vector>

#include "physics/contact/shapes.h"
#include "scene/scene.h"

namespace ziggurat::physics {

struct PlacedCollider {
  contact::Shape shape;
  btTransform pose;     ///< of the shape's centre, in the world
  btScalar radius = 0;  ///< of the bounding sphere [m]
};

/// Those of an entity at its pose, joints as assembled.
std::vector<PlacedCollider> placed_colliders(const scene::Entity& entity);

/// One of our collision objects where it is.
PlacedCollider placed_collider(const btCollisionObject& object);

/// Touching is not overlapping.
bool overlaps(const PlacedCollider& a, const PlacedCollider& b);

}  // namespace ziggurat::physics
