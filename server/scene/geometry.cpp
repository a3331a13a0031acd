// SPDX-License-Identifier: MIT
#include "scene/geometry.h"

#include <algorithm>
#include <cmath>

namespace ziggurat::scene {
namespace {

using math::Vector3;

/// Bounds of a shape on the origin with half extents x and y.
Bounds standing(double x, double y, double height) { return {{-x, -y, 0}, {x, y, height}}; }

Bounds bounds_of(const Box& box) {
  return standing(box.size.x() / 2, box.size.y() / 2, box.size.z());
}
Bounds bounds_of(const Cylinder& cylinder) {
  return standing(cylinder.radius, cylinder.radius, cylinder.height);
}
Bounds bounds_of(const Sphere& sphere) {
  return standing(sphere.radius, sphere.radius, 2 * sphere.radius);
}
Bounds bounds_of(const Capsule& capsule) {
  return standing(capsule.radius, capsule.radius, capsule.height);
}
Bounds bounds_of(const Hull& hull) {
  const std::vector<Vector3>& vertices = hull.polyhedron->vertices;
  Bounds bounds{vertices[0], vertices[0]};
  for (const Vector3& vertex : vertices) {
    bounds.low = bounds.low.cwiseMin(vertex);
    bounds.high = bounds.high.cwiseMax(vertex);
  }
  return bounds;
}

double reach_of(const Box& box, const Vector3& direction) {
  return 0.5 * box.size.head<2>().dot(direction.head<2>().cwiseAbs()) +
         std::max(box.size.z() * direction.z(), 0.0);
}
double reach_of(const Cylinder& cylinder, const Vector3& direction) {
  return cylinder.radius * direction.head<2>().norm() +
         std::max(cylinder.height * direction.z(), 0.0);
}
double reach_of(const Sphere& sphere, const Vector3& direction) {
  return sphere.radius * (1 + direction.z());
}
double reach_of(const Capsule& capsule, const Vector3& direction) {
  return capsule.radius * (1 + direction.z()) +
         std::max((capsule.height - 2 * capsule.radius) * direction.z(), 0.0);
}
double reach_of(const Hull& hull, const Vector3& direction) {
  double most = direction.dot(hull.polyhedron->vertices[0]);
  for (const Vector3& vertex : hull.polyhedron->vertices) {
    most = std::max(most, direction.dot(vertex));
  }
  return most;
}

}  // namespace

Bounds bounds(const Geometry& geometry) {
  return std::visit([](const auto& shape) { return bounds_of(shape); }, geometry);
}

double reach(const Geometry& geometry, const Vector3& direction) {
  return std::visit([&](const auto& shape) { return reach_of(shape, direction); }, geometry);
}

}  // namespace ziggurat::scene
