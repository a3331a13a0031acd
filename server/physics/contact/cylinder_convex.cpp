// Cylinder against box or cylinder. The normal is the best of the flat faces' axes and of what
// GJK finds; the contact points are the other body's feature clipped against that face.

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>

#include "physics/contact/pairs.h"
#include "physics/contact/polygon.h"

namespace ziggurat::physics::contact {
namespace {

/// A box or cylinder with what the search needs of it.
struct Body {
  const Box* box = nullptr;
  const Cylinder* cylinder = nullptr;
  btVector3 centre;
  btVector3 axis[3];

  Body(const Shape& shape, const btTransform& pose)
      : box(std::get_if<Box>(&shape)),
        cylinder(std::get_if<Cylinder>(&shape)),
        centre(pose.getOrigin()) {
    for (int i = 0; i < 3; ++i) axis[i] = pose.getBasis().getColumn(i);
  }

  /// Half the width along a unit direction [m].
  btScalar extent(const btVector3& direction) const {
    if (box) {
      return box->half[0] * btFabs(axis[0].dot(direction)) +
             box->half[1] * btFabs(axis[1].dot(direction)) +
             box->half[2] * btFabs(axis[2].dot(direction));
    }
    const btScalar along = axis[2].dot(direction);
    return cylinder->half_height * btFabs(along) +
           cylinder->radius * btSqrt(btMax(btScalar(0), 1 - along * along));
  }
  btScalar smallest() const {
    return box ? box->half[box->half.minAxis()] : btMin(cylinder->radius, cylinder->half_height);
  }
};

btScalar separation(const Body& a, const Body& b, const btVector3& b_to_a) {
  return b_to_a.dot(a.centre - b.centre) - a.extent(b_to_a) - b.extent(b_to_a);
}

/// The nearest direction by GJK on cores shrunk by a margin, or EPA where they overlap.
struct Nearest {
  btVector3 b_to_a{0, 0, 1};
  btVector3 on_b{0, 0, 0};
  btScalar distance = -BT_LARGE_FLOAT;
};

Nearest nearest(const Body& a, const btTransform& pose_a, const Body& b,
                const btTransform& pose_b) {
  const auto search = [&](const btConvexShape& shape_a, const btConvexShape& shape_b) {
    Nearest found;
    btGjkEpaSolver2::sResults results;
    // Bullet takes the guess and gives the normal in A's frame, the witnesses in the world.
    const btMatrix3x3& basis = pose_a.getBasis();
    const btVector3 guess = basis.transpose() * (pose_a.getOrigin() - pose_b.getOrigin());
    const bool apart =
        btGjkEpaSolver2::Distance(&shape_a, pose_a, &shape_b, pose_b, guess, results) &&
        results.distance > 0;
    if (!apart &&
        !btGjkEpaSolver2::Penetration(&shape_a, pose_a, &shape_b, pose_b, guess, results)) {
      return found;
    }
    const btScalar length = results.normal.length();
    if (!(length > SIMD_EPSILON)) return found;
    found.b_to_a = basis * (results.normal / length);
    if (separation(a, b, -found.b_to_a) > separation(a, b, found.b_to_a))
      found.b_to_a = -found.b_to_a;
    found.distance = separation(a, b, found.b_to_a);
    found.on_b = results.witnesses[1];
    if (apart) found.on_b += found.b_to_a * shape_b.getMargin();
    return found;
  };
  const btScalar margin = btScalar(0.1) * btMin(a.smallest(), b.smallest());
  btCylinderShapeZ shape_a({a.cylinder->radius, a.cylinder->radius, a.cylinder->half_height});
  shape_a.setMargin(margin);
  if (b.box) {
    btBoxShape shape_b(b.box->half);
    shape_b.setMargin(margin);
    return search(shape_a, shape_b);
  }
  btCylinderShapeZ shape_b({b.cylinder->radius, b.cylinder->radius, b.cylinder->half_height});
  shape_b.setMargin(margin);
  return search(shape_a, shape_b);
}

/// The flat face whose axis separates best.
struct Face {
  bool of_a = false;
  int axis = -1;
  btVector3 outward;
  btScalar distance = -BT_LARGE_FLOAT;
};

void consider_faces(const Body& body, const Body& other, bool of_a, btScalar prefer, Face& best) {
  for (int i = body.box ? 0 : 2; i < 3; ++i) {
    const btVector3 outward =
        body.axis[i].dot(other.centre - body.centre) < 0 ? -body.axis[i] : body.axis[i];
    const btScalar distance =
        of_a ? separation(body, other, -outward) : separation(other, body, outward);
    if (distance > best.distance + (best.axis >= 0 ? prefer : 0))
      best = {of_a, i, outward, distance};
  }
}

btVector3 perpendicular(const btVector3& axis, const btVector3& towards,
                        const btVector3& fallback) {
  btVector3 result = towards - axis * axis.dot(towards);
  if (result.length2() < btScalar(1e-12)) return fallback;
  return result.normalized();
}

/// The feature of a body that faces a direction: a face, a cap as an octagon, or a side line.
Polygon feature(const Body& body, const btVector3& towards) {
  Polygon polygon;
  if (body.box) {
    int face = 0;
    for (int i = 1; i < 3; ++i) {
      if (btFabs(body.axis[i].dot(towards)) > btFabs(body.axis[face].dot(towards))) face = i;
    }
    const btVector3& half = body.box->half;
    const btScalar sign = body.axis[face].dot(towards) < 0 ? -1 : 1;
    const btVector3 centre = body.centre + body.axis[face] * (sign * half[face]);
    const int u = (face + 1) % 3, v = (face + 2) % 3;
    const btVector3 du = body.axis[u] * half[u], dv = body.axis[v] * half[v];
    polygon.add(centre + du + dv);
    polygon.add(centre - du + dv);
    polygon.add(centre - du - dv);
    polygon.add(centre + du - dv);
    return polygon;
  }
  const btVector3& axis = body.axis[2];
  const btScalar along = axis.dot(towards);
  const btVector3 deepest = perpendicular(axis, towards, body.axis[0]);
  const btVector3 rim = deepest * body.cylinder->radius;
  if (btFabs(along) < btScalar(0.5)) {
    polygon.add(body.centre + axis * body.cylinder->half_height + rim);
    polygon.add(body.centre - axis * body.cylinder->half_height + rim);
    return polygon;
  }
  const btVector3 centre =
      body.centre + axis * (along < 0 ? -body.cylinder->half_height : body.cylinder->half_height);
  const btVector3 across = axis.cross(rim);
  const btScalar diagonal = SIMDSQRT12;
  polygon.add(centre + rim);
  polygon.add(centre + (rim + across) * diagonal);
  polygon.add(centre + across);
  polygon.add(centre + (across - rim) * diagonal);
  polygon.add(centre - rim);
  polygon.add(centre - (rim + across) * diagonal);
  polygon.add(centre - across);
  polygon.add(centre + (rim - across) * diagonal);
  return polygon;
}

/// Cuts a polygon to the outline of a face: a rectangle, or a disc as 16 tangents.
void clip_to_face(Polygon& polygon, const Body& body, int face) {
  if (body.box) {
    for (const int side : {(face + 1) % 3, (face + 2) % 3}) {
      for (const int sign : {1, -1}) {
        const btVector3 normal = body.axis[side] * sign;
        clip(polygon, normal, normal.dot(body.centre) + body.box->half[side]);
      }
    }
    return;
  }
  static const btScalar cosines[16] = {1,  .92387953251128674,  SIMDSQRT12,  .38268343236508978,
                                       0,  -.38268343236508978, -SIMDSQRT12, -.92387953251128674,
                                       -1, -.92387953251128674, -SIMDSQRT12, -.38268343236508978,
                                       0,  .38268343236508978,  SIMDSQRT12,  .92387953251128674};
  for (int i = 0; i < 16; ++i) {
    const btVector3 normal = body.axis[0] * cosines[i] + body.axis[1] * cosines[(i + 12) % 16];
    clip(polygon, normal, normal.dot(body.centre) + body.cylinder->radius);
  }
}

void clip_features(const Face& face, const Body& reference, const Body& incident, btScalar reach,
                   Contacts& out) {
  Polygon polygon = feature(incident, -face.outward);
  clip_to_face(polygon, reference, face.axis);
  const btScalar plane = face.outward.dot(reference.centre) + reference.extent(face.outward);
  for (int i = 0; i < polygon.count; ++i) {
    const btVector3& vertex = polygon.vertices[i];
    const btScalar distance = face.outward.dot(vertex) - plane;
    if (distance <= reach) {
      out.add(face.of_a ? vertex : vertex - face.outward * distance, distance);
    }
  }
}

/// A line of B that a side line of A may lie along: a side line, or the box edge nearest.
bool edge_along(const Body& b, const btVector3& b_to_a, const btVector3& direction,
                btVector3& middle, btScalar& half_length) {
  if (b.cylinder) {
    if (btFabs(b.axis[2].dot(b_to_a)) > btScalar(0.1) ||
        btFabs(b.axis[2].dot(direction)) < btScalar(0.99)) {
      return false;
    }
    middle = b.centre + perpendicular(b.axis[2], b_to_a, b.axis[0]) * b.cylinder->radius;
    half_length = b.cylinder->half_height;
    return true;
  }
  for (int i = 0; i < 3; ++i) {
    if (btFabs(b.axis[i].dot(direction)) < btScalar(0.99)) continue;
    middle = b.centre;
    for (const int side : {(i + 1) % 3, (i + 2) % 3}) {
      middle +=
          b.axis[side] * (b.axis[side].dot(b_to_a) < 0 ? -b.box->half[side] : b.box->half[side]);
    }
    half_length = b.box->half[i];
    return true;
  }
  return false;
}

/// The side of A along an edge or side line of B: the two ends of what they share.
bool add_line(const Body& a, const Body& b, const Nearest& near, Contacts& out) {
  const btVector3& axis = a.axis[2];
  btVector3 middle;
  btScalar half_length;
  if (btFabs(axis.dot(near.b_to_a)) > btScalar(0.1) ||
      !edge_along(b, near.b_to_a, axis, middle, half_length)) {
    return false;
  }
  const btScalar offset = axis.dot(middle - a.centre);
  const btScalar from = btMax(-a.cylinder->half_height, offset - half_length);
  const btScalar to = btMin(a.cylinder->half_height, offset + half_length);
  if (to - from < btScalar(0.1) * a.cylinder->half_height) return false;
  out.add(middle + axis * (from - offset), near.distance);
  out.add(middle + axis * (to - offset), near.distance);
  return true;
}

}  // namespace

void cylinder_convex(const Cylinder& cylinder, const btTransform& pose_a, const Shape& shape_b,
                     const btTransform& pose_b, btScalar reach, Contacts& out) {
  const Shape shape_a = cylinder;
  const Body a(shape_a, pose_a), b(shape_b, pose_b);
  const btScalar prefer = btScalar(1e-3) * btMin(a.smallest(), b.smallest());

  Face face;
  consider_faces(b, a, false, prefer, face);
  if (face.distance > reach) return;
  consider_faces(a, b, true, prefer, face);
  if (face.distance > reach) return;
  const Nearest near = nearest(a, pose_a, b, pose_b);
  if (near.distance > reach) return;

  if (face.distance >= near.distance - 5 * prefer) {
    out.normal = face.of_a ? -face.outward : face.outward;
    clip_features(face, face.of_a ? a : b, face.of_a ? b : a, reach, out);
    if (out.count > 0) return;
  }
  if (near.distance == -BT_LARGE_FLOAT) return;
  out.normal = near.b_to_a;
  if (!add_line(a, b, near, out)) out.add(near.on_b, near.distance);
}

}  // namespace ziggurat::physics::contact
