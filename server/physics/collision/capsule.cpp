// SPDX-License-Identifier: MIT
// Capsule against capsule: where their segments are nearest, in closed form.

#include "physics/collision/pairs.h"

namespace ziggurat::physics::contact {
namespace {

struct Segment {
  btVector3 center, axis;  // unit
  btScalar half;           // [m]

  Segment(const Capsule& capsule, const btTransform& pose)
      : center(pose.getOrigin()), axis(pose.getBasis().getColumn(2)), half(capsule.half_length) {}

  btScalar nearest(const btVector3& point) const {
    return btMax(-half, btMin(half, axis.dot(point - center)));
  }
  btVector3 at(btScalar along) const { return center + axis * along; }
};

/// The contact of the balls at two points of the segments.
void add(const Capsule& a, const btVector3& on_a, const Capsule& b, const btVector3& on_b,
         btScalar reach, Manifold& out) {
  const btVector3 between = on_a - on_b;
  const btScalar length = between.length();
  const btScalar distance = length - a.radius - b.radius;
  if (distance > reach) return;
  if (out.count == 0) out.normal = length > 0 ? between / length : btVector3(0, 0, 1);
  out.add(on_b + out.normal * b.radius, distance);
}

}  // namespace

void contact_points(const Capsule& a, const Capsule& b, const PosedPair& at, Manifold& out) {
  const Segment first(a, at.a), second(b, at.b);
  const btScalar cosine = first.axis.dot(second.axis);
  constexpr btScalar parallel = btScalar(0.9999);  // within 0.8 degrees
  if (btFabs(cosine) < parallel) {
    // Nearest points of the lines, moved into both segments (C. Ericson, 2005, 5.1.9).
    const btVector3 between = second.center - first.center;
    const btScalar of_first = first.axis.dot(between), of_second = second.axis.dot(between);
    const btScalar line = (of_first - cosine * of_second) / (1 - cosine * cosine);
    btScalar along = btMax(-first.half, btMin(first.half, line));
    const btScalar across = second.nearest(first.at(along));
    along = first.nearest(second.at(across));
    return add(a, first.at(along), b, second.at(across), at.reach, out);
  }
  // Side by side: the two ends of what they share; end to end that is one point.
  const btScalar middle = first.axis.dot(second.center - first.center);
  const btScalar low = btMax(-first.half, middle - second.half);
  const btScalar high = btMin(first.half, middle + second.half);
  if (high - low < btScalar(0.1) * btMin(a.radius, b.radius)) {
    const btScalar along = btMax(-first.half, btMin(first.half, (low + high) / 2));
    const btVector3 on_b = second.at(second.nearest(first.at(along)));
    return add(a, first.at(first.nearest(on_b)), b, on_b, at.reach, out);
  }
  for (const btScalar along : {low, high}) {
    add(a, first.at(along), b, second.at(second.nearest(first.at(along))), at.reach, out);
  }
}

}  // namespace ziggurat::physics::contact
