// SPDX-License-Identifier: MIT
#include "physics/collision/shape.h"

#include <BulletCollision/CollisionShapes/btConvexHullShape.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "physics/bodies/convert.h"

namespace ziggurat::physics {
namespace {

using math::Pose;
using math::Vector3;

Pose above(double height) { return {{0, 0, height}, math::Quaternion::Identity()}; }

// --- box ----------------------------------------------------------------------------------------

Pose frame_of(const scene::Box& box) { return above(box.size.z() / 2); }

Vector3 inertia_of(const scene::Box& box, double mass) {
  const Vector3 squares = box.size.cwiseAbs2();
  return mass / 12 *
         Vector3(squares.y() + squares.z(), squares.x() + squares.z(), squares.x() + squares.y());
}

Vector3 extents_of(const scene::Box& box) { return box.size / 2; }

double depth_of(const scene::Box& box, const Vector3& point) {
  return (box.size / 2 - point.cwiseAbs()).minCoeff();
}

contact::Shape contact_of(const scene::Box& box) {
  return contact::Box{to_bullet(Vector3(box.size / 2))};
}

// --- cylinder -----------------------------------------------------------------------------------

Pose frame_of(const scene::Cylinder& cylinder) { return above(cylinder.height / 2); }

Vector3 inertia_of(const scene::Cylinder& cylinder, double mass) {
  const double r2 = cylinder.radius * cylinder.radius;
  const double side = mass * (3 * r2 + cylinder.height * cylinder.height) / 12;
  return {side, side, mass * r2 / 2};
}

Vector3 extents_of(const scene::Cylinder& cylinder) {
  return {cylinder.radius, cylinder.radius, cylinder.height / 2};
}

double depth_of(const scene::Cylinder& cylinder, const Vector3& point) {
  return std::min(cylinder.radius - point.head<2>().norm(),
                  cylinder.height / 2 - std::abs(point.z()));
}

contact::Shape contact_of(const scene::Cylinder& cylinder) {
  return contact::Cylinder{cylinder.radius, cylinder.height / 2};
}

// --- sphere -------------------------------------------------------------------------------------

Pose frame_of(const scene::Sphere& sphere) { return above(sphere.radius); }

Vector3 inertia_of(const scene::Sphere& sphere, double mass) {
  return Vector3::Constant(0.4 * mass * sphere.radius * sphere.radius);
}

Vector3 extents_of(const scene::Sphere& sphere) { return Vector3::Constant(sphere.radius); }

double depth_of(const scene::Sphere& sphere, const Vector3& point) {
  return sphere.radius - point.norm();
}

contact::Shape contact_of(const scene::Sphere& sphere) { return contact::Sphere{sphere.radius}; }

// --- capsule ------------------------------------------------------------------------------------

double half_segment(const scene::Capsule& capsule) { return capsule.height / 2 - capsule.radius; }

Pose frame_of(const scene::Capsule& capsule) { return above(capsule.height / 2); }

/// A cylinder, and two half-balls: each with 83/320 m r^2 across about its own centre of mass,
/// which is 3/8 r from its flat side.
Vector3 inertia_of(const scene::Capsule& capsule, double mass) {
  const double r = capsule.radius, r2 = r * r, length = 2 * half_segment(capsule);
  const double cylinder_volume = std::numbers::pi * r2 * length;
  const double balls_volume = 4.0 / 3.0 * std::numbers::pi * r2 * r;
  const double cylinder = mass * cylinder_volume / (cylinder_volume + balls_volume);
  const double balls = mass - cylinder;
  const double arm = length / 2 + 3.0 / 8.0 * r;
  const double side =
      cylinder * (3 * r2 + length * length) / 12 + balls * (83.0 / 320.0 * r2 + arm * arm);
  return {side, side, cylinder * r2 / 2 + 0.4 * balls * r2};
}

Vector3 extents_of(const scene::Capsule& capsule) {
  return {capsule.radius, capsule.radius, capsule.height / 2};
}

double depth_of(const scene::Capsule& capsule, const Vector3& point) {
  const double half = half_segment(capsule);
  const Vector3 nearest(0, 0, std::clamp(point.z(), -half, half));
  return capsule.radius - (point - nearest).norm();
}

contact::Shape contact_of(const scene::Capsule& capsule) {
  return contact::Capsule{capsule.radius, half_segment(capsule)};
}

// --- hull ---------------------------------------------------------------------------------------

Pose frame_of(const scene::Hull& hull) {
  return {hull.polyhedron->center_of_mass, hull.polyhedron->axes};
}

Vector3 inertia_of(const scene::Hull& hull, double mass) { return mass * hull.polyhedron->inertia; }

/// Corners in S [m].
std::vector<btVector3> corners_of(const scene::Hull& hull) {
  const Pose into = math::inverse(frame_of(hull));
  std::vector<btVector3> corners;
  for (const Vector3& vertex : hull.polyhedron->vertices) {
    corners.push_back(to_bullet(Vector3(into * vertex)));
  }
  return corners;
}

Vector3 extents_of(const scene::Hull& hull) {
  Vector3 extents = Vector3::Zero();
  for (const btVector3& corner : corners_of(hull)) {
    extents = extents.cwiseMax(from_bullet(corner).cwiseAbs());
  }
  return extents;
}

double depth_of(const scene::Hull& hull, const Vector3& point) {
  const Vector3 in_link = frame_of(hull) * point;
  double depth = std::numeric_limits<double>::infinity();
  for (const scene::Polyhedron::Face& face : hull.polyhedron->faces) {
    depth = std::min(depth, face.offset - face.normal.dot(in_link));
  }
  return depth;
}

std::unique_ptr<btConvexHullShape> bullet_hull(const scene::Hull& hull) {
  const std::vector<btVector3> corners = corners_of(hull);
  auto shape = std::make_unique<btConvexHullShape>(
      &corners[0].m_floats[0], static_cast<int>(corners.size()), int{sizeof(btVector3)});
  shape->setMargin(0);
  shape->recalcLocalAabb();
  return shape;
}

contact::Shape contact_of(const scene::Hull& hull) {
  const scene::Polyhedron& polyhedron = *hull.polyhedron;
  const math::Quaternion into = polyhedron.axes.conjugate();
  auto out = std::make_shared<contact::Polyhedron>();
  out->corners = corners_of(hull);
  for (const btVector3& corner : out->corners) {
    out->radius = btMax(out->radius, corner.length());
  }
  out->smallest = BT_LARGE_FLOAT;
  for (const scene::Polyhedron::Face& face : polyhedron.faces) {
    const double offset = face.offset - face.normal.dot(polyhedron.center_of_mass);
    contact::Polyhedron::Face side{to_bullet(Vector3(into * face.normal)), offset, {}};
    for (const std::size_t corner : face.corners) side.corners.push_back(static_cast<int>(corner));
    out->smallest = btMin(out->smallest, offset);
    out->faces.push_back(std::move(side));
  }
  out->bullet = bullet_hull(hull);
  return contact::Hull{std::move(out)};
}

}  // namespace

math::Pose shape_frame(const scene::Geometry& geometry) {
  return std::visit([](const auto& shape) { return frame_of(shape); }, geometry);
}

Vector3 inertia(const scene::Geometry& geometry, double mass) {
  return std::visit([&](const auto& shape) { return inertia_of(shape, mass); }, geometry);
}

Vector3 half_extents(const scene::Geometry& geometry) {
  return std::visit([](const auto& shape) { return extents_of(shape); }, geometry);
}

double depth(const scene::Geometry& geometry, const Vector3& point) {
  return std::visit([&](const auto& shape) { return depth_of(shape, point); }, geometry);
}

contact::Shape contact_shape(const scene::Geometry& geometry) {
  return std::visit([](const auto& shape) { return contact_of(shape); }, geometry);
}

}  // namespace ziggurat::physics
