// Spheres against round and square bodies: one point, in closed form.

#include "physics/contact/pairs.h"

namespace ziggurat::physics::contact {
namespace {

/// One contact of a sphere (A) with the nearest surface point of B.
/// @param outward  unit normal of B there; @param depth  distance of the sphere's centre
void add(const Sphere& a, const btVector3& surface, const btVector3& outward, btScalar depth,
         btScalar reach, Contacts& out) {
  const btScalar distance = depth - a.radius;
  if (distance > reach) return;
  out.normal = outward;
  out.add(surface, distance);
}

}  // namespace

void sphere_sphere(const Sphere& a, const btTransform& pose_a, const Sphere& b,
                   const btTransform& pose_b, btScalar reach, Contacts& out) {
  const btVector3 between = pose_a.getOrigin() - pose_b.getOrigin();
  const btScalar length = between.length();
  const btVector3 outward = length > 0 ? between / length : btVector3(0, 0, 1);
  add(a, pose_b.getOrigin() + outward * b.radius, outward, length - b.radius, reach, out);
}

void sphere_box(const Sphere& a, const btTransform& pose_a, const Box& b, const btTransform& pose_b,
                btScalar reach, Contacts& out) {
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

void sphere_cylinder(const Sphere& a, const btTransform& pose_a, const Cylinder& b,
                     const btTransform& pose_b, btScalar reach, Contacts& out) {
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
    outward /= depth;
  }
  add(a, pose_b * nearest, pose_b.getBasis() * outward, depth, reach, out);
}

}  // namespace ziggurat::physics::contact
