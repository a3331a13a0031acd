// SPDX-License-Identifier: MIT
// Cylinders, capsules and hulls against each other and against boxes. The normal is the best of the
// flat faces' axes and of what GJK finds; the contact points are the other body's feature clipped
// against that face.

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>

#include "physics/collision/pairs.h"

namespace ziggurat::physics::contact {
namespace {

btScalar separation(const Body& a, const Body& b, const btVector3& b_to_a) {
  return b_to_a.dot(a.centre - b.centre) - extent(a, -b_to_a) - extent(b, b_to_a);
}

/// The nearest direction by GJK on cores shrunk by a margin, or EPA where they overlap.
struct Nearest {
  btVector3 b_to_a{0, 0, 1};
  btVector3 on_b{0, 0, 0};
  btScalar distance = -BT_LARGE_FLOAT;
  bool apart = false;  ///< the cores are
};

Nearest search(const Body& a, const btConvexShape& shape_a, const Body& b,
               const btConvexShape& shape_b, const PosedPair& at) {
  Nearest found;
  btGjkEpaSolver2::sResults results;
  // Bullet takes the guess and gives the normal in A's frame, the witnesses in the world.
  const btMatrix3x3& basis = at.a.getBasis();
  const btVector3 guess = basis.transpose() * (at.a.getOrigin() - at.b.getOrigin());
  found.apart = btGjkEpaSolver2::Distance(&shape_a, at.a, &shape_b, at.b, guess, results) &&
                results.distance > 0;
  if (!found.apart &&
      !btGjkEpaSolver2::Penetration(&shape_a, at.a, &shape_b, at.b, guess, results)) {
    return found;
  }
  const btScalar length = results.normal.length();
  if (!(length > SIMD_EPSILON)) return found;
  found.b_to_a = basis * (results.normal / length);
  if (separation(a, b, -found.b_to_a) > separation(a, b, found.b_to_a))
    found.b_to_a = -found.b_to_a;
  found.distance = separation(a, b, found.b_to_a);
  found.on_b = results.witnesses[1];
  if (found.apart) found.on_b += found.b_to_a * shape_b.getMargin();
  return found;
}

// Calls `use` with a shape of Bullet's.
template <class Use>
Nearest with_shape(const Box& box, btScalar margin, Use use) {
  btBoxShape shape(box.half);
  shape.setMargin(margin);
  return use(shape);
}
template <class Use>
Nearest with_shape(const Cylinder& cylinder, btScalar margin, Use use) {
  btCylinderShapeZ shape({cylinder.radius, cylinder.radius, cylinder.half_height});
  shape.setMargin(margin);
  return use(shape);
}
template <class Use>
Nearest with_shape(const Capsule& capsule, btScalar, Use use) {
  return use(btCapsuleShapeZ(capsule.radius, 2 * capsule.half_length));  // its margin: the radius
}
template <class Use>
Nearest with_shape(const Hull& hull, btScalar, Use use) {
  return use(*hull.polyhedron->bullet);
}

/// @param margin  by which cores of boxes and cylinders are smaller: their edges are round [m]
Nearest nearest(const Body& a, const Body& b, const PosedPair& at, btScalar margin) {
  return std::visit(
      [&](const auto* first, const auto* second) {
        return with_shape(*first, margin, [&](const btConvexShape& shape_a) {
          return with_shape(*second, margin, [&](const btConvexShape& shape_b) {
            return search(a, shape_a, b, shape_b, at);
          });
        });
      },
      a.shape, b.shape);
}

/// The flat face whose axis separates best.
struct BestFace {
  bool of_a = false;
  int number = -1;
  btVector3 outward;
  btScalar distance = -BT_LARGE_FLOAT;
  btVector3 b_to_a() const { return of_a ? -outward : outward; }
};

void consider_faces(const Body& body, const Body& other, bool of_a, btScalar prefer,
                    BestFace& best) {
  for (int i = 0; i < face_count(body); ++i) {
    const btVector3 outward = face_towards(body, i, other.centre);
    const btScalar distance =
        of_a ? separation(body, other, -outward) : separation(other, body, outward);
    if (distance > best.distance + (best.number >= 0 ? prefer : 0))
      best = {of_a, i, outward, distance};
  }
}

void clip_features(const BestFace& face, const Body& reference, const Body& incident,
                   btScalar reach, Manifold& out) {
  Polygon polygon = feature(incident, -face.outward);
  clip_to_face(polygon, reference, face.number);
  const btScalar plane = face.outward.dot(reference.centre) + extent(reference, face.outward);
  for (int i = 0; i < polygon.count; ++i) {
    const btVector3& vertex = polygon.vertices[i];
    const btScalar distance = face.outward.dot(vertex) - plane;
    if (distance <= reach) {
      out.add(face.of_a ? vertex : vertex - face.outward * distance, distance);
    }
  }
}

/// Position of a side along another line.
struct Station {
  btVector3 on_other;
  btScalar distance;
};

/// @param along  of the side's middle, in its direction [m]
Station station(const Line& side, btScalar along, const Line& other, const btVector3& normal) {
  const btVector3 here = side.middle + side.direction * along;
  const btScalar across = other.direction.dot(here - other.middle);
  const btVector3 on_axis =
      other.middle + other.direction * btMax(-other.half_length, btMin(other.half_length, across));
  const btVector3 between = here - on_axis;
  // The side's rim at its end is turned against the other by as much as their axes are.
  const btScalar length = between.length();
  const btScalar along_side = side.direction.dot(between);
  const btScalar rim =
      length > 0 ? side.radius *
                       btSqrt(btMax(btScalar(0), 1 - along_side * along_side / (length * length)))
                 : side.radius;
  const btScalar height = normal.dot(between);
  return {on_axis + normal * other.radius, (height < 0 ? height : length) - rim - other.radius};
}

/// The side of A along an edge or side of B, and the part that they share, from the middle of A's
/// [m].
struct Shared {
  Line of_a, of_b;
  btScalar from = 0, to = 0;
};

/// @return  whether they lie so
bool lie_along(const Body& a, const Body& b, const Nearest& near, Shared& out) {
  if (!side(a, out.of_a) || btFabs(out.of_a.direction.dot(near.b_to_a)) > almost_across ||
      !edge_along(b, near.b_to_a, near.on_b, out.of_a.direction, out.of_b)) {
    return false;
  }
  const btScalar offset = out.of_a.direction.dot(out.of_b.middle - out.of_a.middle);
  const btScalar share = out.of_b.half_length * btFabs(out.of_a.direction.dot(out.of_b.direction));
  out.from = btMax(-out.of_a.half_length, offset - share);
  out.to = btMin(out.of_a.half_length, offset + share);
  return out.to - out.from >= btScalar(0.1) * out.of_a.half_length;
}

/// Takes the direction from the edge to the axis, if it separates better: exact where they touch,
/// where GJK finds none.
void look_across(const Body& a, const Body& b, Nearest& near) {
  Shared shared;
  if (!lie_along(a, b, near, shared)) return;
  const Line &of_a = shared.of_a, &of_b = shared.of_b;
  const btVector3 here = of_a.middle + of_a.direction * ((shared.from + shared.to) / 2);
  const btVector3 on_axis = of_b.middle + of_b.direction * of_b.direction.dot(here - of_b.middle);
  btVector3 across = here - on_axis;
  across -= of_a.direction * of_a.direction.dot(across);
  const btScalar length = across.length();
  if (!(length > SIMD_EPSILON)) return;
  across /= length;
  const btScalar distance = separation(a, b, across);
  if (distance > near.distance) near = {across, on_axis + across * of_b.radius, distance, true};
}

/// The two ends of what a side and an edge share, each with its own distance.
void add_line(const Body& a, const Body& b, const Nearest& near, btScalar reach, Manifold& out) {
  Shared shared;
  if (!lie_along(a, b, near, shared)) return;
  for (const btScalar along : {shared.from, shared.to}) {
    const Station end = station(shared.of_a, along, shared.of_b, near.b_to_a);
    if (end.distance <= reach) out.add(end.on_other, btMax(end.distance, near.distance));
  }
}

/// Adds further points of the best face, below the nearest point: they may touch within the
/// substep.
void add_beside(const BestFace& face, const Body& a, const Body& b, const Nearest& near,
                btScalar reach, btScalar prefer, Manifold& out) {
  const btScalar cosine = face.b_to_a().dot(near.b_to_a);
  // The side of a capsule that faces the normal is not the one that faces the face.
  if (cosine < btScalar(0.98) || std::holds_alternative<const Capsule*>(a.shape)) return;
  Manifold beside;
  clip_features(face, face.of_a ? a : b, face.of_a ? b : a, reach * cosine, beside);
  for (int i = 0; i < beside.count; ++i) {
    const btScalar distance = beside.points[i].distance / cosine;
    if (distance > near.distance + prefer) out.add(beside.points[i].on_b, distance);
  }
}

constexpr btScalar touching = btScalar(1e-6);  // what is nearer to a surface is on it [m]

/// The nearest direction and point of the shapes themselves. Where they touch GJK finds none, and
/// what it finds may be anything: then as if they were a little apart.
/// @param near  by cores
Nearest nearest_sharp(const Body& a, const Body& b, const PosedPair& at, const Nearest& near) {
  constexpr btScalar apart = btScalar(1e-4);  // [m]
  const Nearest sharp = nearest(a, b, at, 0);
  if (sharp.distance > -BT_LARGE_FLOAT && btFabs(near.distance) > touching) return sharp;
  btTransform moved = at.a;
  moved.setOrigin(moved.getOrigin() + apart * near.b_to_a);
  Nearest beside = nearest(a, b, {moved, at.b, at.reach, at.support, at.useful}, 0);
  if (!beside.apart) return sharp;
  beside.distance = separation(a, b, beside.b_to_a);
  return beside;
}

/// Takes the axis of largest separation. Edges between cores are round: near a touch the direction
/// is one between the faces that meet there, and the point is off the surface.
/// @param sharp  of the shapes themselves
void sharpen(Nearest& near, const BestFace& face, const Nearest& sharp) {
  if (sharp.distance == -BT_LARGE_FLOAT) return;
  if (btFabs(near.distance) < touching) near.on_b = sharp.on_b;
  if (sharp.distance > near.distance) near = sharp;
  if (face.distance > near.distance) near = {face.b_to_a(), sharp.on_b, face.distance, true};
}

btScalar least(const Manifold& contacts) {
  btScalar distance = BT_LARGE_FLOAT;
  for (int i = 0; i < contacts.count; ++i) {
    distance = btMin(distance, contacts.points[i].distance);
  }
  return distance;
}

}  // namespace

void clipped_contacts(const Body& a, const Body& b, const PosedPair& at, Manifold& out) {
  const btScalar prefer = btScalar(1e-3) * btMin(smallest(a), smallest(b));

  BestFace face;
  consider_faces(b, a, false, prefer, face);
  const btScalar most = btMin(at.reach, at.useful + 10 * prefer);
  if (face.distance > most) return;
  consider_faces(a, b, true, prefer, face);
  if (face.distance > most) return;
  Nearest near = nearest(a, b, at, btScalar(0.1) * btMin(smallest(a), smallest(b)));
  if (near.distance > at.reach) return;

  if (face.distance >= near.distance - 5 * prefer) {
    out.normal = face.b_to_a();
    clip_features(face, face.of_a ? a : b, face.of_a ? b : a, at.reach, out);
    // The ball at the end of a capsule may be nearest beyond the face's outline.
    const bool enough =
        !std::holds_alternative<const Capsule*>(a.shape) || least(out) < near.distance + 5 * prefer;
    if (out.count > 0 && enough) return;
    out.count = 0;
  }
  if (near.distance == -BT_LARGE_FLOAT) return;
  if (near.apart) sharpen(near, face, nearest_sharp(a, b, at, near));
  look_across(a, b, near);
  if (near.distance > at.reach) return;
  out.normal = near.b_to_a;
  add_line(a, b, near, at.reach, out);
  if (out.count == 0 || least(out) > near.distance + btScalar(0.1) * prefer)
    out.add(near.on_b, near.distance);
  if (out.count == 1) add_beside(face, a, b, near, at.reach, prefer, out);
}

}  // namespace ziggurat::physics::contact
