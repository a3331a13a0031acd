// SPDX-License-Identifier: MIT
// Chooses the function for a pair of shapes, and thins out what it found.

#include <algorithm>
#include <type_traits>

#include "physics/collision/pairs.h"

namespace ziggurat::physics::contact {
namespace {

/// Whether a function for (A, B) in this order exists.
template <class A, class B>
concept Ordered = requires(const A& a, const B& b, const PosedPair& at, Manifold& out) {
  contact_points(a, b, at, out);
};

/// Grows with the angle of (x, y) from 0 to 4 over a full turn; cheaper than an arc tangent and
/// the same on every processor.
btScalar turn(btScalar x, btScalar y) {
  const btScalar sum = btFabs(x) + btFabs(y);
  if (sum == 0) return 0;
  const btScalar part = x / sum;
  return y < 0 ? 3 + part : 1 - part;
}

// Radius of the sphere about the shape's centre that holds it [m]:
btScalar radius_of(const Box& box) { return box.half.length(); }
btScalar radius_of(const Cylinder& cylinder) {
  return btSqrt(cylinder.radius * cylinder.radius + cylinder.half_height * cylinder.half_height);
}
btScalar radius_of(const Sphere& sphere) { return sphere.radius; }
btScalar radius_of(const Capsule& capsule) { return capsule.radius + capsule.half_length; }
btScalar radius_of(const Hull& hull) { return hull.polyhedron->radius; }
btScalar radius_of(const HalfSpace&) {
  return 0;
}  // it is no ball: far_apart() treats it by itself

}  // namespace

btScalar bounding_radius(const Shape& shape) {
  return std::visit([](const auto& each) { return radius_of(each); }, shape);
}

namespace {

// Whether a point of the shape's frame lies in it or within `slack`:
bool inside(const Box& box, const btVector3& p, btScalar slack) {
  return btFabs(p.x()) <= box.half.x() + slack && btFabs(p.y()) <= box.half.y() + slack &&
         btFabs(p.z()) <= box.half.z() + slack;
}
bool inside(const Cylinder& cylinder, const btVector3& p, btScalar slack) {
  const btScalar radius = cylinder.radius + slack;
  return btFabs(p.z()) <= cylinder.half_height + slack &&
         p.x() * p.x() + p.y() * p.y() <= radius * radius;
}
bool inside(const Sphere& sphere, const btVector3& p, btScalar slack) {
  return p.length() <= sphere.radius + slack;
}
bool inside(const Capsule& capsule, const btVector3& p, btScalar slack) {
  const btScalar z = std::clamp(p.z(), -capsule.half_length, capsule.half_length);
  return (p - btVector3(0, 0, z)).length() <= capsule.radius + slack;
}
bool inside(const Hull& hull, const btVector3& p, btScalar slack) {
  return std::ranges::all_of(hull.polyhedron->faces, [&](const Polyhedron::Face& face) {
    return face.normal.dot(p) <= face.offset + slack;
  });
}
bool inside(const HalfSpace&, const btVector3& p, btScalar slack) { return p.z() <= slack; }

// Extent of the shape along a unit direction of its frame [m]:
btScalar reach_of(const Box& box, const btVector3& d) { return box.half.dot(d.absolute()); }
btScalar reach_of(const Cylinder& cylinder, const btVector3& d) {
  return cylinder.radius * btSqrt(d.x() * d.x() + d.y() * d.y()) +
         cylinder.half_height * btFabs(d.z());
}
btScalar reach_of(const Sphere& sphere, const btVector3&) { return sphere.radius; }
btScalar reach_of(const Capsule& capsule, const btVector3& d) {
  return capsule.radius + capsule.half_length * btFabs(d.z());
}
btScalar reach_of(const Hull& hull, const btVector3& d) {
  btScalar most = -BT_LARGE_FLOAT;
  for (const btVector3& corner : hull.polyhedron->corners) most = btMax(most, corner.dot(d));
  return most;
}
btScalar reach_of(const HalfSpace&, const btVector3& d) {
  return d.z() > 1 - 1e-12 ? 0 : BT_LARGE_FLOAT;
}

/// Whether the bodies are too far apart for any contact; costs next to nothing.
bool far_apart(const Shape& a, const btTransform& pose_a, const Shape& b, const btTransform& pose_b,
               btScalar reach) {
  const btVector3 between = pose_a.getOrigin() - pose_b.getOrigin();
  if (std::holds_alternative<HalfSpace>(b)) {
    return between.dot(pose_b.getBasis().getColumn(2)) > bounding_radius(a) + reach;
  }
  if (std::holds_alternative<HalfSpace>(a)) {
    return -between.dot(pose_a.getBasis().getColumn(2)) > bounding_radius(b) + reach;
  }
  const btScalar most = bounding_radius(a) + bounding_radius(b) + reach;
  return between.length2() > most * most;
}

}  // namespace

void swap_sides(Manifold& contacts) {
  for (int i = 0; i < contacts.count; ++i) {
    contacts.points[i].on_b += contacts.normal * contacts.points[i].distance;
  }
  contacts.normal = -contacts.normal;
}

Manifold find(const Shape& a, const btTransform& pose_a, const Shape& b, const btTransform& pose_b,
              btScalar reach, Support support, btScalar useful) {
  Manifold out;
  const bool flat = std::holds_alternative<HalfSpace>(a) || std::holds_alternative<HalfSpace>(b);
  if (far_apart(a, pose_a, b, pose_b, flat ? btMin(reach, useful) : reach)) return out;
  std::visit(
      [&](const auto& first, const auto& second) {
        using A = std::decay_t<decltype(first)>;
        using B = std::decay_t<decltype(second)>;
        if constexpr (Ordered<A, B>) {
          contact_points(first, second, {pose_a, pose_b, reach, support, useful}, out);
        } else {
          contact_points(second, first, {pose_b, pose_a, reach, support, useful}, out);
          swap_sides(out);
        }
      },
      a, b);
  return out;
}

bool contains(const Shape& shape, const btVector3& point, btScalar slack) {
  return std::visit([&](const auto& each) { return inside(each, point, slack); }, shape);
}

const Polyhedron::Face& face_along(const Polyhedron& polyhedron, const btVector3& direction) {
  const Polyhedron::Face* best = &polyhedron.faces[0];
  for (const Polyhedron::Face& face : polyhedron.faces) {
    if (face.normal.dot(direction) > best->normal.dot(direction)) best = &face;
  }
  return *best;
}

btScalar reach_along(const Shape& shape, const btVector3& direction) {
  return std::visit([&](const auto& each) { return reach_of(each, direction); }, shape);
}

namespace {

/// Two directions in the plane of contact that turn with a frame.
struct Across {
  btVector3 first, second;

  Across(const btVector3& normal, const btTransform& frame) {
    const int up = (frame.getBasis().transpose() * normal).absolute().maxAxis();
    first = frame.getBasis().getColumn((up + 1) % 3);
    second = frame.getBasis().getColumn((up + 2) % 3);
  }
};

/// The deepest point; of those within the usual overlap, one at a place that turns with the bodies.
/// Otherwise rounding would change it from one substep to the next, and resting bodies would
/// vibrate.
int steadily_deepest(const Manifold& contacts, const Across& across) {
  constexpr btScalar same = btScalar(1e-6);  // depth [m]
  const btVector3 towards =
      across.first +
      btScalar(0.6) * across.second;  // no symmetry of squares has points at the same place
  const auto& points = contacts.points;
  btScalar least = points[0].distance;
  for (int i = 1; i < contacts.count; ++i) least = btMin(least, points[i].distance);
  int best = -1;
  for (int i = 0; i < contacts.count; ++i) {
    if (points[i].distance > least + same) continue;
    if (best < 0 || towards.dot(points[i].on_b - points[best].on_b) > 0) best = i;
  }
  return best;
}

/// Keeps the deepest point, the one farthest from it, and those farthest to both sides of the line
/// between them.
void keep_four(Manifold& contacts, int deepest) {
  auto& points = contacts.points;
  // Ties go to the first: a later point must be better by more than rounding.
  const btScalar better = 1 + btScalar(1e-6), tiny = btScalar(1e-12);
  int farthest = deepest, left = deepest, right = deepest;
  btScalar most = 0;
  for (int i = 0; i < contacts.count; ++i) {
    const btScalar away = (points[i].on_b - points[deepest].on_b).length2();
    if (away > most * better + tiny) most = away, farthest = i;
  }
  const btVector3 base = points[farthest].on_b - points[deepest].on_b;
  btScalar most_left = 0, most_right = 0;
  for (int i = 0; i < contacts.count; ++i) {
    const btScalar area = base.cross(points[i].on_b - points[deepest].on_b).dot(contacts.normal);
    if (area > most_left * better + tiny) most_left = area, left = i;
    if (area < most_right * better - tiny) most_right = area, right = i;
  }
  const int kept[4] = {deepest, farthest, left, right};
  std::array<ManifoldPoint, 4> chosen;
  int count = 0;
  for (int i = 0; i < 4; ++i) {
    if (std::find(kept, kept + i, kept[i]) == kept + i) chosen[count++] = points[kept[i]];
  }
  std::copy_n(chosen.begin(), count, points.begin());
  contacts.count = count;
}

}  // namespace

void reduce(Manifold& contacts, const btTransform& frame) {
  if (contacts.count < 2) return;
  auto& points = contacts.points;
  const Across across(contacts.normal, frame);
  if (contacts.count > 4) keep_four(contacts, steadily_deepest(contacts, across));
  // A stable order makes the solver go the same way each step: by angle about the middle.
  btVector3 middle(0, 0, 0);
  for (int i = 0; i < contacts.count; ++i) middle += points[i].on_b;
  middle /= btScalar(contacts.count);
  std::array<std::pair<btScalar, int>, 4> ordered;
  for (int i = 0; i < contacts.count; ++i) {
    const btVector3 arm = points[i].on_b - middle;
    ordered[i] = {turn(arm.dot(across.first), arm.dot(across.second)), i};
  }
  const auto first = ordered.begin(), last = first + contacts.count;
  if (std::is_sorted(first, last)) return;
  for (auto next = first; next != last; ++next)  // of equal angles the first point comes first
    std::rotate(std::upper_bound(first, next, *next), next, next + 1);
  std::array<ManifoldPoint, 4> chosen;
  for (int i = 0; i < contacts.count; ++i) chosen[i] = points[ordered[i].second];
  std::copy_n(chosen.begin(), contacts.count, points.begin());
}

}  // namespace ziggurat::physics::contact
