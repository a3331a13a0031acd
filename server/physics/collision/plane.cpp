// SPDX-License-Identifier: MIT
// All shapes against a half-space.

#include <algorithm>
#include <cmath>

#include "physics/collision/pairs.h"

namespace ziggurat::physics::contact {
namespace {

/// Adds a point of A by its height over the plane.
void add(const btVector3& point, const btTransform& plane, btScalar reach, Manifold& out) {
  const btScalar distance = out.normal.dot(point - plane.getOrigin());
  if (distance <= reach) out.add(point - out.normal * distance, distance);
}

/// Up to this sine of the tilt a cap counts as flat: its rim is then 0.6 % of the radius off.
constexpr btScalar flat_tilt = 0.02;
/// From this cosine of the tilt on a cylinder stands on a cap; below, it lies on its side.
constexpr btScalar standing = 0.7;

/// The lowest direction in a cap that is nearly flat, one of 4096 that are fixed in the body. So it
/// does not change with every rounding, and a cylinder tips over each point of its rim alike.
/// @param x, y  in the cap;  @param down  the direction, of the length of the sine of the tilt
btVector3 steady(const btVector3& x, const btVector3& y, const btVector3& down) {
  constexpr btScalar steps = 1024, rounding = btScalar(1e-11);
  const btScalar along = down.dot(x), across = down.dot(y), sum = btFabs(along) + btFabs(across);
  if (sum < rounding) return x;
  const btScalar share = std::round(steps * along / sum) / steps;
  return x * share + y * (across < 0 ? btFabs(share) - 1 : 1 - btFabs(share));
}

/// The corners of the face that looks down most.
void add_lower_face(const Box& box, const PosedPair& at, Manifold& out) {
  const btVector3 up = at.a.getBasis().transpose() * out.normal;  // in the box
  const int face = up.absolute().maxAxis();
  const int u = (face + 1) % 3, v = (face + 2) % 3;
  for (int corner = 0; corner < 4; ++corner) {
    btVector3 point;
    point[face] = up[face] > 0 ? -box.half[face] : box.half[face];
    point[u] = corner & 1 ? box.half[u] : -box.half[u];
    point[v] = corner & 2 ? box.half[v] : -box.half[v];
    add(at.a * point, at.b, at.reach, out);
  }
}

/// Points of a hull, and other corners as low as its lowest one: an edge or a corner that carries
/// may belong to other faces.
void add_lower_face(const Hull& hull, const PosedPair& at, Manifold& out) {
  constexpr btScalar as_low = btScalar(1e-5);  // [m]
  const Polyhedron& polyhedron = *hull.polyhedron;
  const btVector3 down = at.a.getBasis().transpose() * -out.normal;  // in the hull
  const std::vector<int>& face = face_along(polyhedron, down).corners;
  const btScalar lowest = reach_along(hull, down);
  for (std::size_t i = 0; i < polyhedron.corners.size(); ++i) {
    const btVector3& corner = polyhedron.corners[i];
    const bool carries = corner.dot(down) > lowest - as_low ||
                         std::ranges::find(face, static_cast<int>(i)) != face.end();
    if (carries) add(at.a * corner, at.b, at.reach, out);
  }
}

}  // namespace

void contact_points(const Box& a, const HalfSpace&, const PosedPair& at, Manifold& out) {
  const auto& [pose_a, plane, reach, support, useful] = at;
  out.normal = plane.getBasis().getColumn(2);
  const btVector3& half = a.half;
  if (support == Support::face) return add_lower_face(a, at, out);
  for (int corner = 0; corner < 8; ++corner) {
    add(pose_a * btVector3(corner & 1 ? half.x() : -half.x(), corner & 2 ? half.y() : -half.y(),
                           corner & 4 ? half.z() : -half.z()),
        plane, reach, out);
  }
}

void contact_points(const Cylinder& a, const HalfSpace&, const PosedPair& at, Manifold& out) {
  const auto& [pose_a, plane, reach, support, useful] = at;
  out.normal = plane.getBasis().getColumn(2);
  // The lower cap is the one that faces the plane.
  const btVector3 axis = pose_a.getBasis().getColumn(2);
  const btScalar up = out.normal.dot(axis);
  const btVector3 to_lower = axis * (up < 0 ? a.half_height : -a.half_height);
  btVector3 down =
      axis * up - out.normal;  // in the caps, towards the plane; its length is sin(tilt)
  const bool flat = down.length2() < flat_tilt * flat_tilt;
  // Flat on its cap the deepest direction is noise: points fixed in the body rest quietly.
  const btVector3 x = pose_a.getBasis().getColumn(0), y = pose_a.getBasis().getColumn(1);
  if (flat) down = steady(x, y, down);
  down *= a.radius / down.length();
  const btVector3 across = axis.cross(down);
  const btVector3 lower = pose_a.getOrigin() + to_lower, upper = pose_a.getOrigin() - to_lower;
  add(lower + down, plane, reach, out);
  if (btFabs(up) < standing) {
    add(upper + down, plane, reach, out);
    return;
  }
  add(lower + across, plane, reach, out);
  add(lower - across, plane, reach, out);
  add(lower - down, plane, reach, out);
}

void contact_points(const Sphere& a, const HalfSpace&, const PosedPair& at, Manifold& out) {
  const auto& [pose_a, plane, reach, support, useful] = at;
  out.normal = plane.getBasis().getColumn(2);
  add(pose_a.getOrigin() - out.normal * a.radius, plane, reach, out);
}

void contact_points(const Capsule& a, const HalfSpace&, const PosedPair& at, Manifold& out) {
  const auto& [pose_a, plane, reach, support, useful] = at;
  out.normal = plane.getBasis().getColumn(2);
  const btVector3 to_end = pose_a.getBasis().getColumn(2) * a.half_length;
  const btVector3 lowest = pose_a.getOrigin() - out.normal * a.radius;
  add(lowest + to_end, plane, reach, out);
  if (a.half_length > 0) add(lowest - to_end, plane, reach, out);
}

void contact_points(const Hull& a, const HalfSpace&, const PosedPair& at, Manifold& out) {
  const auto& [pose_a, plane, reach, support, useful] = at;
  out.normal = plane.getBasis().getColumn(2);
  if (support == Support::face) return add_lower_face(a, at, out);
  for (const btVector3& corner : a.polyhedron->corners) add(pose_a * corner, plane, reach, out);
}

}  // namespace ziggurat::physics::contact
