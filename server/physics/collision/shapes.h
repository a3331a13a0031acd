// SPDX-License-Identifier: MIT
#pragma once
// The contact geometry of the engine: points at which two convex bodies touch, or will within the
// next substep. Functions are pure functions of dimensions and poses; Bullet only lends its vector
// types.
//
// Bullet's own manifolds are not used: they report nothing at positive distance and are built one
// point per step. Here a whole manifold is made each step, with points that are still apart.

#include <BulletCollision/CollisionShapes/btConvexShape.h>
#include <LinearMath/btTransform.h>

#include <array>
#include <memory>
#include <variant>
#include <vector>

namespace ziggurat::physics::contact {

struct Box {
  btVector3 half;  ///< half extents [m]
};
struct Cylinder {
  btScalar radius;       ///< [m]
  btScalar half_height;  ///< along its z [m]
};
struct Sphere {
  btScalar radius;  ///< [m]
};
/// All points within `radius` of a segment.
struct Capsule {
  btScalar radius;       ///< [m]
  btScalar half_length;  ///< of the segment, along its z [m]
};
/// A convex solid with flat faces about its frame's origin.
struct Polyhedron {
  struct Face {
    btVector3 normal;          ///< unit, outwards
    btScalar offset;           ///< normal . x of its points [m]
    std::vector<int> corners;  ///< counterclockwise seen from outside
  };
  std::vector<btVector3> corners;  ///< [m]
  std::vector<Face> faces;
  btScalar radius = 0;    ///< of the sphere about the origin that holds it [m]
  btScalar smallest = 0;  ///< distance of the nearest face from the origin [m]
  std::unique_ptr<const btConvexShape> bullet;  ///< the same for GJK, without margin
};
struct Hull {
  static constexpr int most_corners = 64;
  std::shared_ptr<const Polyhedron> polyhedron;
};
/// The half-space z <= 0 of its frame.
struct HalfSpace {};

using Shape = std::variant<Box, Cylinder, Sphere, Capsule, Hull, HalfSpace>;

/// Radius of the sphere about the shape's centre that holds it [m]; 0 of a half-space.
btScalar bounding_radius(const Shape& shape);

struct ManifoldPoint {
  btVector3 on_b;     ///< on the surface of B, in the world [m]
  btScalar distance;  ///< along the normal; negative = overlap [m]
  /// From the place opposite, along the normal, to where the other body meets it: of what stands,
  /// or of B [m].
  btVector3 offset_when_met;
};

/// Points that share one normal. Before reduction there may be up to `capacity` of them.
struct Manifold {
  static constexpr int capacity = Hull::most_corners;
  btVector3 normal{0, 0, 0};  ///< unit, from B to A
  int count = 0;
  std::array<ManifoldPoint, capacity> points;

  void add(const btVector3& on_b, btScalar distance) {
    if (count < capacity) points[count++] = {on_b, distance, {0, 0, 0}};
  }
};

/// Which points of a box or a hull carry it on a half-space.
enum class Support {
  face,  ///< the corners of the face that looks down most: those that land when a plank falls flat
  all    ///< all its corners, for what tumbles
};

/// Contacts of two bodies whose shape centres stand at the given world poses.
/// @param reach   points farther apart than this are left out [m]
/// @param useful  where all points would surely be farther apart than this, there may be none [m]
Manifold find(const Shape& a, const btTransform& pose_a, const Shape& b, const btTransform& pose_b,
              btScalar reach, Support support = Support::face, btScalar useful = BT_LARGE_FLOAT);

/// Whether a point lies in a shape or within `slack` of it.
/// @param point  in the shape's frame [m];  @param slack  [m]
bool contains(const Shape& shape, const btVector3& point, btScalar slack);

/// The face that looks most along a direction of the polyhedron's frame; of equals the first.
const Polyhedron::Face& face_along(const Polyhedron& polyhedron, const btVector3& direction);

/// Extent of a shape from its centre along a unit direction of its frame [m]; without bound:
/// BT_LARGE_FLOAT.
btScalar reach_along(const Shape& shape, const btVector3& direction);

/// Keeps at most four points that span the contact: the deepest within 1 um, the farthest from it
/// and the two that enclose the largest area.
/// They are ordered by angle in the given frame, that of a body of the pair. The choice does not
/// depend on depths that differ by less, or on the order of the points.
void reduce(Manifold& contacts, const btTransform& frame);

}  // namespace ziggurat::physics::contact
