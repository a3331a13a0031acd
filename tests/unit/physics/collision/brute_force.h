// SPDX-License-Identifier: MIT
#pragma once
// Contact geometry by search: slow and simple, to compare the fast one with.

#include <LinearMath/btTransform.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "physics/collision/shapes.h"

namespace ziggurat::physics::contact::testing {

inline const Box cube{{0.005, 0.005, 0.005}};
inline const Cylinder can{0.005, 0.005};

/// A shape at a pose.
struct Solid {
  Shape shape;
  btTransform pose;

  /// Its extent from its centre in a unit direction [m]. Not for half-spaces.
  btScalar extent(const btVector3& direction) const {
    const btVector3 local = pose.getBasis().transpose() * direction;
    if (const auto* box = std::get_if<Box>(&shape)) return local.absolute().dot(box->half);
    if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
      return cylinder->radius * std::hypot(local.x(), local.y()) +
             cylinder->half_height * std::fabs(local.z());
    }
    if (const auto* capsule = std::get_if<Capsule>(&shape)) {
      return capsule->radius + capsule->half_length * std::fabs(local.z());
    }
    if (const auto* hull = std::get_if<Hull>(&shape)) {
      btScalar most = -BT_LARGE_FLOAT;
      for (const btVector3& corner : hull->polyhedron->corners) {
        most = std::max(most, corner.dot(local));
      }
      return most;
    }
    return std::get<Sphere>(shape).radius;
  }

  /// Distance of a point from the surface, negative inside [m].
  btScalar distance(const btVector3& point) const {
    const btVector3 local = pose.invXform(point);
    if (const auto* box = std::get_if<Box>(&shape)) {
      const btVector3 beyond = local.absolute() - box->half;
      btVector3 outside = beyond;
      outside.setMax({0, 0, 0});
      return outside.length() + std::min(beyond[beyond.maxAxis()], btScalar(0));
    }
    if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
      const btScalar side = std::hypot(local.x(), local.y()) - cylinder->radius;
      const btScalar cap = std::fabs(local.z()) - cylinder->half_height;
      return std::hypot(std::max(side, btScalar(0)), std::max(cap, btScalar(0))) +
             std::min(std::max(side, cap), btScalar(0));
    }
    if (const auto* sphere = std::get_if<Sphere>(&shape)) return local.length() - sphere->radius;
    if (const auto* capsule = std::get_if<Capsule>(&shape)) {
      const btScalar along = std::clamp(local.z(), -capsule->half_length, capsule->half_length);
      return (local - btVector3(0, 0, along)).length() - capsule->radius;
    }
    if (const auto* hull = std::get_if<Hull>(&shape)) {  // outside: no more than the distance
      btScalar most = -BT_LARGE_FLOAT;
      for (const auto& face : hull->polyhedron->faces) {
        most = std::max(most, face.normal.dot(local) - face.offset);
      }
      return most;
    }
    return local.z();
  }

  /// Least half width [m].
  btScalar smallest() const {
    if (const auto* box = std::get_if<Box>(&shape)) return box->half[box->half.minAxis()];
    if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
      return std::min(cylinder->radius, cylinder->half_height);
    }
    if (const auto* capsule = std::get_if<Capsule>(&shape)) return capsule->radius;
    if (const auto* hull = std::get_if<Hull>(&shape)) return hull->polyhedron->smallest;
    const auto* sphere = std::get_if<Sphere>(&shape);
    return sphere ? sphere->radius : BT_LARGE_FLOAT;
  }
};

/// Gap between the slabs that enclose the two shapes along a unit direction [m].
inline btScalar slab_gap(const Solid& a, const Solid& b, const btVector3& b_to_a) {
  if (std::holds_alternative<HalfSpace>(b.shape)) {
    return b_to_a.dot(a.pose.getOrigin() - b.pose.getOrigin()) - a.extent(-b_to_a);
  }
  return b_to_a.dot(a.pose.getOrigin() - b.pose.getOrigin()) - a.extent(-b_to_a) - b.extent(b_to_a);
}

struct Gap {
  btScalar distance =
      -BT_LARGE_FLOAT;        ///< of two bodies, or minus the smallest penetration depth [m]
  btVector3 b_to_a{0, 0, 1};  ///< unit
};

/// Directions spread evenly over the sphere.
inline std::vector<btVector3> spread(int count) {
  std::vector<btVector3> directions;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2.0 * i + 1) / count, angle = 2.39996322972865332 * i;
    const double r = std::sqrt(1 - z * z);
    directions.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  }
  return directions;
}

/// The widest gap over all directions between convex bodies: a search in all directions, then
/// refined about the best ones. For separate bodies this is their distance.
inline Gap true_gap(const Solid& a, const Solid& b) {
  if (std::holds_alternative<HalfSpace>(b.shape)) {
    const btVector3 up = b.pose.getBasis().getColumn(2);
    return {slab_gap(a, b, up), up};
  }
  static const std::vector<btVector3> everywhere = spread(1500);
  std::vector<btVector3> directions = everywhere;
  for (int i = 0; i < 3; ++i) {
    for (const btScalar sign : {-1, 1}) {
      directions.push_back(a.pose.getBasis().getColumn(i) * sign);
      directions.push_back(b.pose.getBasis().getColumn(i) * sign);
    }
  }
  std::vector<Gap> gaps;
  for (const btVector3& direction : directions) {
    gaps.push_back({slab_gap(a, b, direction), direction});
  }
  std::partial_sort(gaps.begin(), gaps.begin() + 6, gaps.end(),
                    [](const Gap& p, const Gap& q) { return p.distance > q.distance; });
  Gap best;
  for (int k = 0; k < 6; ++k) {
    Gap here = gaps[k];
    int tries = 0;
    for (double step = 0.06; step > 1e-7 && tries < 300; ++tries) {
      btVector3 u, v;
      btPlaneSpace1(here.b_to_a, u, v);
      Gap next = here;
      for (int i = 0; i < 8; ++i) {
        const double angle = i * M_PI / 4;
        const btVector3 direction =
            (here.b_to_a + (u * std::cos(angle) + v * std::sin(angle)) * step).normalized();
        const btScalar distance = slab_gap(a, b, direction);
        if (distance > next.distance) next = {distance, direction};
      }
      if (next.distance > here.distance + 1e-12) {
        here = next;
      } else {
        step *= 0.5;
      }
    }
    if (here.distance > best.distance) best = here;
  }
  return best;
}

}  // namespace ziggurat::physics::contact::testing
