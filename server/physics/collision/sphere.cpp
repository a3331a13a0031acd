// SPDX-License-Identifier: MIT
// Spheres against all others: one point, in closed form but for hulls.

#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>

#include "physics/collision/pairs.h"

namespace ziggurat::physics::contact {
namespace {

/// One contact of a sphere (A) with the nearest surface point of B.
/// @param outward  unit normal of B there; @param depth  distance of the sphere's centre
void add(const Sphere& a, const btVector3& surface, const btVector3& outward, btScalar depth,
         btScalar reach, Manifold& out) {
  const btScalar distance = depth - a.radius;
  if (distance > reach) return;
  out.normal = outward;
  out.add(surface, distance);
}

/// One contact of a sphere with another.
void add_round(const Sphere& a, const btVector3& center_a, btScalar radius_b,
               const btVector3& center_b, btScalar reach, Manifold& out) {
  const btVector3 between = center_a - center_b;
  const btScalar length = between.length();
  const btVector3 outward = length > 0 ? between / length : btVector3(0, 0, 1);
  add(a, center_b + outward * radius_b, outward, length - radius_b, reach, out);
}

}  // namespace

void contact_points(const Sphere& a, const Sphere& b, const PosedPair& at, Manifold& out) {
  add_round(a, at.a.getOrigin(), b.radius, at.b.getOrigin(), at.reach, out);
}

void contact_points(const Sphere& a, const Capsule& b, const PosedPair& at, Manifold& out) {
  const btVector3 axis = at.b.getBasis().getColumn(2);
  const btScalar along = axis.dot(at.a.getOrigin() - at.b.getOrigin());
  const btScalar nearest = btMax(-b.half_length, btMin(b.half_length, along));
  add_round(a, at.a.getOrigin(), b.radius, at.b.getOrigin() + axis * nearest, at.reach, out);
}

void contact_points(const Sphere& a, const Box& b, const PosedPair& at, Manifold& out) {
  const auto& [pose_a, pose_b, reach, support, useful] = at;
  const btVector3 centre = pose_b.invXform(pose_a.getOrigin());
  btVector3 nearest = centre;
  nearest.setMax(-b.half);
  nearest.setMin(b.half);
  const btVector3 between = centre - nearest;
  const btScalar length = between.length();
  if (length > 0) {
    add(a, pose_b * nearest, pose_b.getBasis() * (between / length), length, reach, out);
    return;
  }
  // The centre is inside: leave by the nearest face.
  int face = 0;
  btScalar depth = BT_LARGE_FLOAT;
  for (int i = 0; i < 3; ++i) {
    const btScalar inside = b.half[i] - btFabs(centre[i]);
    if (inside < depth) {
      depth = inside;
      face = i;
    }
  }
  btVector3 outward(0, 0, 0);
  outward[face] = centre[face] < 0 ? -1 : 1;
  nearest[face] = outward[face] * b.half[face];
  add(a, pose_b * nearest, pose_b.getBasis() * outward, -depth, reach, out);
}

void contact_points(const Sphere& a, const Cylinder& b, const PosedPair& at, Manifold& out) {
  const auto& [pose_a, pose_b, reach, support, useful] = at;
  const btVector3 centre = pose_b.invXform(pose_a.getOrigin());
  const btScalar radial = btSqrt(centre.x() * centre.x() + centre.y() * centre.y());
  const btVector3 side =
      radial > 0 ? btVector3(centre.x() / radial, centre.y() / radial, 0) : btVector3(1, 0, 0);
  const btScalar beyond_side = radial - b.radius;
  const btScalar beyond_cap = btFabs(centre.z()) - b.half_height;
  const btScalar up = centre.z() < 0 ? -1 : 1;
  btVector3 nearest = centre;
  btVector3 outward;
  btScalar depth;
  if (beyond_side <= 0 && beyond_cap <= 0) {  // inside: leave by the nearer of side and cap
    const bool by_side = beyond_side > beyond_cap;
    outward = by_side ? side : btVector3(0, 0, up);
    depth = by_side ? beyond_side : beyond_cap;
    nearest = centre - outward * depth;
  } else {
    if (beyond_side > 0) nearest = side * b.radius + btVector3(0, 0, centre.z());
    if (beyond_cap > 0) nearest.setZ(up * b.half_height);
    outward = centre - nearest;
    depth = outward.length();
    // On the surface but for rounding there is no way to it.
    outward = depth > 1e-9 * b.radius ? outward / depth
              : beyond_side > 0       ? side
                                      : btVector3(0, 0, up);
  }
  add(a, pose_b * nearest, pose_b.getBasis() * outward, depth, reach, out);
}

void contact_points(const Sphere& a, const Hull& b, const PosedPair& at, Manifold& out) {
  const auto& [pose_a, pose_b, reach, support, useful] = at;
  const btVector3 centre = pose_b.invXform(pose_a.getOrigin());
  const Polyhedron::Face* nearest = &b.polyhedron->faces[0];
  const auto height = [&](const Polyhedron::Face& face) {
    return face.normal.dot(centre) - face.offset;
  };
  for (const Polyhedron::Face& face : b.polyhedron->faces) {
    if (height(face) > height(*nearest)) nearest = &face;
  }
  const btScalar depth = height(*nearest);
  if (depth - a.radius > reach) return;
  if (depth > 0) {
    btSphereShape ball(a.radius);
    btGjkEpaSolver2::sResults results;
    if (btGjkEpaSolver2::Distance(&ball, pose_a, b.polyhedron->bullet.get(), pose_b,
                                  btVector3(1, 0, 0), results)) {
      const btVector3 between = pose_a.getOrigin() - results.witnesses[1];
      const btScalar length = between.length();
      if (length > 0) return add(a, results.witnesses[1], between / length, length, reach, out);
    }
  }
  // The centre is inside, or touches: leave by the nearest face.
  add(a, pose_b * (centre - nearest->normal * depth), pose_b.getBasis() * nearest->normal, depth,
      reach, out);
}

}  // namespace ziggurat::physics::contact
