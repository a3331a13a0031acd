#include "physics/geometry.h"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <cmath>

#include "physics/convert.h"

namespace ziggurat::physics {

std::unique_ptr<btCollisionShape> bullet_shape(const scene::Geometry& geometry) {
  if (const auto* box = std::get_if<scene::Box>(&geometry)) {
    return std::make_unique<btBoxShape>(to_bullet(math::Vector3(box->size / 2)));
  }
  if (const auto* cylinder = std::get_if<scene::Cylinder>(&geometry)) {
    return std::make_unique<btCylinderShapeZ>(
        btVector3(cylinder->radius, cylinder->radius, cylinder->height / 2));
  }
  return std::make_unique<btSphereShape>(std::get<scene::Sphere>(geometry).radius);
}

contact::Shape contact_shape(const scene::Geometry& geometry) {
  if (const auto* box = std::get_if<scene::Box>(&geometry)) {
    return contact::Box{to_bullet(math::Vector3(box->size / 2))};
  }
  if (const auto* cylinder = std::get_if<scene::Cylinder>(&geometry)) {
    return contact::Cylinder{cylinder->radius, cylinder->height / 2};
  }
  return contact::Sphere{std::get<scene::Sphere>(geometry).radius};
}

math::Vector3 half_extents(const scene::Geometry& geometry) {
  if (const auto* box = std::get_if<scene::Box>(&geometry)) return box->size / 2;
  if (const auto* cylinder = std::get_if<scene::Cylinder>(&geometry)) {
    return {cylinder->radius, cylinder->radius, cylinder->height / 2};
  }
  return math::Vector3::Constant(std::get<scene::Sphere>(geometry).radius);
}

double bounding_radius(const scene::Geometry& geometry) {
  if (const auto* box = std::get_if<scene::Box>(&geometry)) return box->size.norm() / 2;
  if (const auto* cylinder = std::get_if<scene::Cylinder>(&geometry)) {
    return std::hypot(cylinder->radius, cylinder->height / 2);
  }
  return std::get<scene::Sphere>(geometry).radius;
}

}  // namespace ziggurat::physics
