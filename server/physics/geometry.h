#pragma once
// A scene's geometry as Bullet's and our own shapes.

#include <BulletCollision/CollisionShapes/btCollisionShape.h>

#include <memory>

#include "physics/contact/shapes.h"
#include "scene/scene.h"

namespace ziggurat::physics {

std::unique_ptr<btCollisionShape> bullet_shape(const scene::Geometry& geometry);
contact::Shape contact_shape(const scene::Geometry& geometry);

/// Of the box about the shape, along its axes [m].
math::Vector3 half_extents(const scene::Geometry& geometry);

/// Of the sphere about the shape's centre that holds it [m].
double bounding_radius(const scene::Geometry& geometry);

}  // namespace ziggurat::physics
