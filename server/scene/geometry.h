// SPDX-License-Identifier: MIT
#pragma once
// The shapes of links. A new one is a struct here; what lacks a function for it then does not
// compile.
//
// The frame of a box, cylinder, sphere or capsule is at the centre of its bottom: the lowest point
// of a sphere or capsule, the centre of the lower face of a box. That of a hull is where its author
// has it.

#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "math/pose.h"

namespace ziggurat::scene {

struct Box {
  math::Vector3 size = math::Vector3::Zero();  ///< full extents along x, y, z [m]
};
struct Cylinder {
  double radius = 0;  ///< [m]
  double height = 0;  ///< along z [m]
};
struct Sphere {
  double radius = 0;  ///< [m]
};
/// A cylinder with a half-ball on either end.
struct Capsule {
  double radius = 0;  ///< [m]
  double height = 0;  ///< along z, from end to end [m]; >= 2 * radius
};

/// A convex solid with flat faces, in the link's frame, and its mass properties.
struct Polyhedron {
  struct Face {
    math::Vector3 normal = math::Vector3::Zero();  ///< unit, outwards
    double offset = 0;                             ///< normal . x of its points [m]
    std::vector<std::size_t> corners;  ///< into `vertices`, counterclockwise seen from outside
  };
  std::vector<math::Vector3> vertices;  ///< [m]
  std::vector<Face> faces;
  math::Vector3 center_of_mass{0, 0, 0};                 ///< of uniform density [m]
  math::Quaternion axes = math::Quaternion::Identity();  ///< principal axes of inertia
  math::Vector3 inertia{0, 0, 0};  ///< along `axes` about the centre of mass, for 1 kg [m^2]
};

/// The convex hull of points.
struct Hull {
  static constexpr std::size_t most_vertices = 64;
  std::shared_ptr<const Polyhedron> polyhedron;
};

using Geometry = std::variant<Box, Cylinder, Sphere, Capsule, Hull>;

/// The box about a shape, along the axes of its frame [m].
struct Bounds {
  math::Vector3 low = math::Vector3::Zero(), high = math::Vector3::Zero();
  math::Vector3 size() const { return high - low; }
  math::Vector3 center() const { return (low + high) / 2; }
};
Bounds bounds(const Geometry& geometry);

/// Support distance of a shape from its frame's origin, along a unit direction of that frame [m].
double reach(const Geometry& geometry, const math::Vector3& direction);

/// The hull of points, or why there is none, as `has no volume; …`.
std::variant<Hull, std::string> make_hull(std::span<const math::Vector3> points);

}  // namespace ziggurat::scene
