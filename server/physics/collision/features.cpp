// SPDX-License-Identifier: MIT
#include "physics/collision/features.h"

namespace ziggurat::physics::contact {
namespace {

constexpr btScalar almost_parallel = btScalar(0.99);  // cosine

btVector3 perpendicular(const btVector3& axis, const btVector3& towards,
                        const btVector3& fallback) {
  btVector3 result = towards - axis * axis.dot(towards);
  if (result.length2() < btScalar(1e-12)) return fallback;
  return result.normalized();
}

btVector3 to_body(const Body& body, const btVector3& direction) {
  return {body.axis[0].dot(direction), body.axis[1].dot(direction), body.axis[2].dot(direction)};
}

btVector3 to_world(const Body& body, const btVector3& in_body) {
  return body.axis[0] * in_body.x() + body.axis[1] * in_body.y() + body.axis[2] * in_body.z();
}

// --- box ----------------------------------------------------------------------------------------

btScalar extent_of(const Box& box, const Body& body, const btVector3& direction) {
  return box.half[0] * btFabs(body.axis[0].dot(direction)) +
         box.half[1] * btFabs(body.axis[1].dot(direction)) +
         box.half[2] * btFabs(body.axis[2].dot(direction));
}

btScalar smallest_of(const Box& box) { return box.half[box.half.minAxis()]; }
int faces_of(const Box&) { return 3; }

btVector3 normal_of(const Box&, const Body& body, int face, const btVector3& point) {
  return body.axis[face].dot(point - body.centre) < 0 ? -body.axis[face] : body.axis[face];
}

Polygon feature_of(const Box& box, const Body& body, const btVector3& towards) {
  Polygon polygon;
  int face = 0;
  for (int i = 1; i < 3; ++i) {
    if (btFabs(body.axis[i].dot(towards)) > btFabs(body.axis[face].dot(towards))) face = i;
  }
  const btVector3& half = box.half;
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

void clip_to(const Box& box, const Body& body, int face, Polygon& polygon) {
  for (const int side : {(face + 1) % 3, (face + 2) % 3}) {
    for (const int sign : {1, -1}) {
      const btVector3 normal = body.axis[side] * sign;
      clip(polygon, normal, normal.dot(body.centre) + box.half[side]);
    }
  }
}

bool side_of(const Box&, const Body&, Line&) { return false; }

bool edge_of(const Box& box, const Body& b, const btVector3&, const btVector3& on_b,
             const btVector3& direction, Line& line) {
  for (int i = 0; i < 3; ++i) {
    if (btFabs(b.axis[i].dot(direction)) < almost_parallel) continue;
    line = {b.centre, b.axis[i], box.half[i], 0};
    for (const int side : {(i + 1) % 3, (i + 2) % 3}) {
      const bool is_below = b.axis[side].dot(on_b - b.centre) < 0;
      line.middle += b.axis[side] * (is_below ? -box.half[side] : box.half[side]);
    }
    return true;
  }
  return false;
}

// --- round sides --------------------------------------------------------------------------------

Line side_line(const Body& body, btScalar radius, btScalar half_length) {
  return {body.centre, body.axis[2], half_length, radius};
}

bool is_along(const Body& b, const btVector3& b_to_a, const btVector3& direction) {
  return btFabs(b.axis[2].dot(b_to_a)) <= almost_across &&
         btFabs(b.axis[2].dot(direction)) >= almost_parallel;
}

// --- cylinder -----------------------------------------------------------------------------------

btScalar extent_of(const Cylinder& cylinder, const Body& body, const btVector3& direction) {
  const btScalar along = body.axis[2].dot(direction);
  return cylinder.half_height * btFabs(along) +
         cylinder.radius * btSqrt(btMax(btScalar(0), 1 - along * along));
}

btScalar smallest_of(const Cylinder& cylinder) {
  return btMin(cylinder.radius, cylinder.half_height);
}
int faces_of(const Cylinder&) { return 1; }

btVector3 normal_of(const Cylinder&, const Body& body, int, const btVector3& point) {
  return body.axis[2].dot(point - body.centre) < 0 ? -body.axis[2] : body.axis[2];
}

Polygon feature_of(const Cylinder& cylinder, const Body& body, const btVector3& towards) {
  Polygon polygon;
  const btVector3& axis = body.axis[2];
  const btScalar along = axis.dot(towards);
  const btVector3 deepest = perpendicular(axis, towards, body.axis[0]);
  const btVector3 rim = deepest * cylinder.radius;
  if (btFabs(along) < btScalar(0.5)) {
    polygon.add(body.centre + axis * cylinder.half_height + rim);
    polygon.add(body.centre - axis * cylinder.half_height + rim);
    return polygon;
  }
  const btVector3 centre =
      body.centre + axis * (along < 0 ? -cylinder.half_height : cylinder.half_height);
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

/// Moves corners of a polygon beyond the rim towards the axis onto it: the clipping planes miss it
/// by up to 2 % of the radius. Where the axis passes beside the polygon they stay.
void pull_to_rim(const Cylinder& cylinder, const Body& body, Polygon& polygon) {
  const btVector3& axis = body.axis[2];
  const auto arm = [&](int i) {
    const btVector3 from_centre = polygon.vertices[i] - body.centre;
    return from_centre - axis * axis.dot(from_centre);
  };
  btScalar least = BT_LARGE_FLOAT, most = -BT_LARGE_FLOAT;
  for (int i = 0; i < polygon.count; ++i) {
    const btScalar area = axis.dot(arm(i).cross(arm((i + 1) % polygon.count)));
    least = btMin(least, area);
    most = btMax(most, area);
  }
  if (least < 0 && most > 0) return;
  for (int i = 0; i < polygon.count; ++i) {
    const btVector3 out = arm(i);
    const btScalar far = out.length();
    if (far > cylinder.radius) polygon.vertices[i] -= out * (1 - cylinder.radius / far);
  }
}

void clip_to(const Cylinder& cylinder, const Body& body, int, Polygon& polygon) {
  static const btScalar cosines[16] = {1,  .92387953251128674,  SIMDSQRT12,  .38268343236508978,
                                       0,  -.38268343236508978, -SIMDSQRT12, -.92387953251128674,
                                       -1, -.92387953251128674, -SIMDSQRT12, -.38268343236508978,
                                       0,  .38268343236508978,  SIMDSQRT12,  .92387953251128674};
  for (int i = 0; i < 16; ++i) {
    const btVector3 normal = body.axis[0] * cosines[i] + body.axis[1] * cosines[(i + 12) % 16];
    clip(polygon, normal, normal.dot(body.centre) + cylinder.radius);
  }
  pull_to_rim(cylinder, body, polygon);
}

bool side_of(const Cylinder& cylinder, const Body& body, Line& line) {
  line = side_line(body, cylinder.radius, cylinder.half_height);
  return true;
}

bool edge_of(const Cylinder& cylinder, const Body& b, const btVector3& b_to_a, const btVector3&,
             const btVector3& direction, Line& line) {
  return is_along(b, b_to_a, direction) && side_of(cylinder, b, line);
}

// --- capsule ------------------------------------------------------------------------------------

btScalar extent_of(const Capsule& capsule, const Body& body, const btVector3& direction) {
  return capsule.half_length * btFabs(body.axis[2].dot(direction)) + capsule.radius;
}

btScalar smallest_of(const Capsule& capsule) { return capsule.radius; }
int faces_of(const Capsule&) { return 0; }
btVector3 normal_of(const Capsule&, const Body&, int, const btVector3&) { return {0, 0, 1}; }

/// The deepest points of both balls.
Polygon feature_of(const Capsule& capsule, const Body& body, const btVector3& towards) {
  Polygon polygon;
  const btVector3 deepest = body.centre + towards * capsule.radius;
  polygon.add(deepest + body.axis[2] * capsule.half_length);
  polygon.add(deepest - body.axis[2] * capsule.half_length);
  return polygon;
}

void clip_to(const Capsule&, const Body&, int, Polygon&) {}
bool side_of(const Capsule& capsule, const Body& body, Line& line) {
  line = side_line(body, capsule.radius, capsule.half_length);
  return true;
}

bool edge_of(const Capsule& capsule, const Body& b, const btVector3& b_to_a, const btVector3&,
             const btVector3& direction, Line& line) {
  return is_along(b, b_to_a, direction) && side_of(capsule, b, line);
}

// --- hull ---------------------------------------------------------------------------------------

btScalar extent_of(const Hull& hull, const Body& body, const btVector3& direction) {
  const btVector3 in_body = to_body(body, direction);
  btScalar most = -BT_LARGE_FLOAT;
  for (const btVector3& corner : hull.polyhedron->corners) most = btMax(most, corner.dot(in_body));
  return most;
}

btScalar smallest_of(const Hull& hull) { return hull.polyhedron->smallest; }
int faces_of(const Hull& hull) { return static_cast<int>(hull.polyhedron->faces.size()); }

const Polyhedron::Face& face_of(const Hull& hull, int face) {
  return hull.polyhedron->faces[static_cast<std::size_t>(face)];
}

btVector3 corner_of(const Hull& hull, const Body& body, int corner) {
  return body.centre + to_world(body, hull.polyhedron->corners[static_cast<std::size_t>(corner)]);
}

btVector3 normal_of(const Hull& hull, const Body& body, int face, const btVector3&) {
  return to_world(body, face_of(hull, face).normal);
}

Polygon feature_of(const Hull& hull, const Body& body, const btVector3& towards) {
  Polygon polygon;
  for (const int corner : face_along(*hull.polyhedron, to_body(body, towards)).corners)
    polygon.add(corner_of(hull, body, corner));
  return polygon;
}

void clip_to(const Hull& hull, const Body& body, int face, Polygon& polygon) {
  const Polyhedron::Face& outline = face_of(hull, face);
  const btVector3 outward = to_world(body, outline.normal);
  btVector3 from = corner_of(hull, body, outline.corners.back());
  for (const int corner : outline.corners) {
    const btVector3 to = corner_of(hull, body, corner);
    const btVector3 normal = (to - from).cross(outward);
    clip(polygon, normal, normal.dot(from));
    from = to;
  }
}

bool side_of(const Hull&, const Body&, Line&) { return false; }

bool edge_of(const Hull& hull, const Body& b, const btVector3&, const btVector3& on_b,
             const btVector3& direction, Line& line) {
  const btVector3 along = to_body(b, direction), near = to_body(b, on_b - b.centre);
  btScalar least = BT_LARGE_FLOAT;
  for (const Polyhedron::Face& face : hull.polyhedron->faces) {
    int from = face.corners.back();
    for (const int to : face.corners) {
      const btVector3& start = hull.polyhedron->corners[static_cast<std::size_t>(from)];
      const btVector3 edge = hull.polyhedron->corners[static_cast<std::size_t>(to)] - start;
      from = to;
      const btScalar length = edge.length();
      if (btFabs(edge.dot(along)) < almost_parallel * length) continue;
      const btVector3 unit = edge / length;
      const btVector3 nearest =
          start + unit * btMax(btScalar(0), btMin(length, unit.dot(near - start)));
      if ((near - nearest).length2() >= least) continue;
      least = (near - nearest).length2();
      line = {b.centre + to_world(b, start + edge / 2), to_world(b, unit), length / 2, 0};
    }
  }
  return least < BT_LARGE_FLOAT;
}

}  // namespace

btScalar extent(const Body& body, const btVector3& direction) {
  return std::visit([&](const auto* shape) { return extent_of(*shape, body, direction); },
                    body.shape);
}

btScalar smallest(const Body& body) {
  return std::visit([](const auto* shape) { return smallest_of(*shape); }, body.shape);
}

int face_count(const Body& body) {
  return std::visit([](const auto* shape) { return faces_of(*shape); }, body.shape);
}

btVector3 face_towards(const Body& body, int face, const btVector3& point) {
  return std::visit([&](const auto* shape) { return normal_of(*shape, body, face, point); },
                    body.shape);
}

Polygon feature(const Body& body, const btVector3& towards) {
  return std::visit([&](const auto* shape) { return feature_of(*shape, body, towards); },
                    body.shape);
}

void clip_to_face(Polygon& polygon, const Body& body, int face) {
  std::visit([&](const auto* shape) { clip_to(*shape, body, face, polygon); }, body.shape);
}

bool side(const Body& body, Line& line) {
  return std::visit([&](const auto* shape) { return side_of(*shape, body, line); }, body.shape);
}

bool edge_along(const Body& b, const btVector3& b_to_a, const btVector3& on_b,
                const btVector3& direction, Line& line) {
  return std::visit(
      [&](const auto* shape) { return edge_of(*shape, b, b_to_a, on_b, direction, line); },
      b.shape);
}

}  // namespace ziggurat::physics::contact
