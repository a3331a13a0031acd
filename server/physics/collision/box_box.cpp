// SPDX-License-Identifier: MIT
// Box against box: separating axes with signed distance (S. Gottschalk 1996), then the incident
// face clipped against the reference face (Sutherland and Hodgman).
// Boxes that overlap always get a contact. Separate ones that are aligned and pass diagonally may
// get none, as the clipped face is empty. So blocks of a lattice, which touch their diagonal
// neighbours along an edge, can slide past them.

#include "physics/collision/pairs.h"
#include "physics/collision/polygon.h"

namespace ziggurat::physics::contact {
namespace {

struct OrientedBox {
  btVector3 half;
  btVector3 axis[3];
  btVector3 centre;

  OrientedBox(const Box& box, const btTransform& pose) : half(box.half), centre(pose.getOrigin()) {
    for (int i = 0; i < 3; ++i) axis[i] = pose.getBasis().getColumn(i);
  }
  btScalar extent(const btVector3& direction) const {
    return half[0] * btFabs(axis[0].dot(direction)) + half[1] * btFabs(axis[1].dot(direction)) +
           half[2] * btFabs(axis[2].dot(direction));
  }
};

struct Separation {
  btScalar distance = -BT_LARGE_FLOAT;  ///< along the axis; negative = overlap
  btVector3 a_to_b{0, 0, 0};            ///< unit
  int axis_a = -1;                      ///< face or edge direction of A; -1 = none
  int axis_b = -1;
};

/// A face of one box touches: its corners on the incident side, clipped to the reference face.
void clip_faces(const OrientedBox& reference, int face, const btVector3& outward,
                const OrientedBox& incident, bool reference_is_a, btScalar reach, Manifold& out) {
  int against = 0;
  btScalar most = -1;
  for (int i = 0; i < 3; ++i) {
    const btScalar aligned = btFabs(incident.axis[i].dot(outward));
    if (aligned > most) {
      most = aligned;
      against = i;
    }
  }
  const btScalar side = incident.axis[against].dot(outward) > 0 ? -1 : 1;
  const btVector3 centre =
      incident.centre + incident.axis[against] * (side * incident.half[against]);
  const int u = (against + 1) % 3, v = (against + 2) % 3;
  const btVector3 du = incident.axis[u] * incident.half[u],
                  dv = incident.axis[v] * incident.half[v];
  Polygon polygon;
  polygon.add(centre + du + dv);
  polygon.add(centre - du + dv);
  polygon.add(centre - du - dv);
  polygon.add(centre + du - dv);
  for (const int side_axis : {(face + 1) % 3, (face + 2) % 3}) {
    for (const int sign : {1, -1}) {
      const btVector3 normal = reference.axis[side_axis] * sign;
      clip(polygon, normal, normal.dot(reference.centre) + reference.half[side_axis]);
    }
  }
  const btScalar plane = outward.dot(reference.centre) + reference.half[face];
  for (int i = 0; i < polygon.count; ++i) {
    const btVector3& vertex = polygon.vertices[i];
    const btScalar distance = outward.dot(vertex) - plane;
    if (distance <= reach) out.add(reference_is_a ? vertex : vertex - outward * distance, distance);
  }
}

/// Two edges cross: one point, on the edge of B where it passes nearest to that of A.
void cross_edges(const OrientedBox& a, const OrientedBox& b, const Separation& edge,
                 Manifold& out) {
  btVector3 on_a = a.centre, on_b = b.centre;
  for (int i = 0; i < 3; ++i) {
    if (i != edge.axis_a)
      on_a += a.axis[i] * (a.axis[i].dot(edge.a_to_b) > 0 ? a.half[i] : -a.half[i]);
    if (i != edge.axis_b)
      on_b += b.axis[i] * (b.axis[i].dot(edge.a_to_b) > 0 ? -b.half[i] : b.half[i]);
  }
  const btVector3& u = a.axis[edge.axis_a];
  const btVector3& w = b.axis[edge.axis_b];
  const btVector3 between = on_b - on_a;
  const btScalar cosine = u.dot(w);
  btScalar along = (between.dot(u) * cosine - between.dot(w)) / (1 - cosine * cosine);
  along = btMax(-b.half[edge.axis_b], btMin(b.half[edge.axis_b], along));
  out.add(on_b + w * along, edge.distance);
}

/// A face of one of two boxes touches.
void touch_face(const OrientedBox& a, const OrientedBox& b, const Separation& face, btScalar reach,
                Manifold& out) {
  if (face.axis_a >= 0) return clip_faces(a, face.axis_a, face.a_to_b, b, true, reach, out);
  clip_faces(b, face.axis_b, -face.a_to_b, a, false, reach, out);
}

/// Adds further points of the best face, above the point where edges cross: they may touch within
/// the substep. A plank that lies on another one's edge rocks on both of its own edges.
void add_beside(const OrientedBox& a, const OrientedBox& b, const Separation& face,
                const Separation& edge, btScalar reach, btScalar prefer, Manifold& out) {
  constexpr btScalar along = btScalar(0.98);  // cosine of the angle between their normals
  const btScalar cosine = face.a_to_b.dot(edge.a_to_b);
  if (cosine < along) return;
  Manifold beside;
  touch_face(a, b, face, reach * cosine, beside);
  for (int i = 0; i < beside.count; ++i) {
    const btScalar distance = beside.points[i].distance / cosine;
    if (distance > edge.distance + prefer) out.add(beside.points[i].on_b, distance);
  }
}

/// An edge of a box.
struct Edge {
  btVector3 middle, direction;  ///< [m]; unit
  btScalar half_length;         ///< [m]
  btVector3 sides[2];           ///< outward normals of the faces that meet there
};

/// The edge along an axis that is farthest in a direction.
Edge edge_of(const OrientedBox& box, int along, const btVector3& direction) {
  Edge edge{box.centre, box.axis[along], box.half[along], {}};
  for (int k = 0; k < 2; ++k) {
    const int i = (along + 1 + k) % 3;
    edge.sides[k] = box.axis[i].dot(direction) < 0 ? -box.axis[i] : box.axis[i];
    edge.middle += edge.sides[k] * box.half[i];
  }
  return edge;
}

/// The axes of two boxes that are parallel, if the boxes are turned against each other about them.
/// @return  whether there are such
bool find_parallel(const OrientedBox& a, const OrientedBox& b, int& axis_a, int& axis_b) {
  constexpr btScalar parallel = btScalar(5e-7), turned = btScalar(0.995);  // 1 - cos 1e-3, cos 0.1
  for (axis_a = 0; axis_a < 3; ++axis_a) {
    for (axis_b = 0; axis_b < 3; ++axis_b) {
      if (btFabs(a.axis[axis_a].dot(b.axis[axis_b])) < 1 - parallel) continue;
      const btVector3& other = a.axis[(axis_a + 1) % 3];
      const btScalar along = btFabs(other.dot(b.axis[(axis_b + 1) % 3]));
      return along < turned && btSqrt(1 - along * along) < turned;
    }
  }
  return false;
}

/// Two edges that lie along each other touch: the ends of what they share. Where they meet, a
/// normal between those of their faces is as good as any; it is that of edges with a radius, so it
/// changes steadily from one face to the other.
/// @param one, other  of A and of B
/// @param radius      of the edges [m]
/// @return  false if it is a face that touches
bool meet_along_edges(const Edge& one, const Edge& other, btScalar radius, btScalar reach,
                      Manifold& out) {
  const btVector3& u = one.direction;
  const btVector3 between = other.middle - one.middle;
  const btVector3 across = between - u * u.dot(between);
  btVector3 normal =
      across + radius * (one.sides[0] + one.sides[1] - other.sides[0] - other.sides[1]);
  normal -= u * u.dot(normal);
  for (int k = 0; k < 2; ++k) {
    if (normal.dot(one.sides[k]) < 0 || normal.dot(other.sides[k]) > 0) return false;
  }
  normal.normalize();
  const btScalar middle = u.dot(between), cosine = u.dot(other.direction);
  const btScalar from = btMax(-one.half_length, middle - other.half_length);
  const btScalar to = btMin(one.half_length, middle + other.half_length);
  if (from >= to) return false;
  out.normal = -normal;
  for (const btScalar place : {from, to}) {
    const btVector3 on_b = other.middle + other.direction * ((place - middle) / cosine);
    const btScalar distance = normal.dot(on_b - one.middle - u * place);
    if (distance <= reach) out.add(on_b, distance);
  }
  return true;
}

}  // namespace

void contact_points(const Box& box_a, const Box& box_b, const PosedPair& at, Manifold& out) {
  const auto& [pose_a, pose_b, reach, support, useful] = at;
  const OrientedBox a(box_a, pose_a), b(box_b, pose_b);
  const btVector3 between = b.centre - a.centre;
  // Preferring A's faces, then B's, then edges keeps resting contacts from flickering.
  const btScalar smallest = btMin(a.half[a.half.minAxis()], b.half[b.half.minAxis()]);
  const btScalar prefer_face = btScalar(1e-3) * smallest, prefer_faces_to_edges = 5 * prefer_face;
  const btScalar most = btMin(reach, useful + 10 * prefer_face);  // the axis that is taken

  Separation face, faces[2];  // the last two: of A and of B
  for (int i = 0; i < 6; ++i) {
    const btVector3& axis = i < 3 ? a.axis[i] : b.axis[i - 3];
    const btScalar along = between.dot(axis);
    const btScalar own = i < 3 ? a.half[i] : b.half[i - 3];
    const btScalar distance = btFabs(along) - own - (i < 3 ? b.extent(axis) : a.extent(axis));
    if (distance > most) return;
    if (distance > face.distance + (i < 3 ? 0 : prefer_face)) {
      face = {distance, along < 0 ? -axis : axis, i < 3 ? i : -1, i < 3 ? -1 : i - 3};
    }
    if (distance > faces[i / 3].distance) {
      faces[i / 3] = {distance, along < 0 ? -axis : axis, i < 3 ? i : -1, i < 3 ? -1 : i - 3};
    }
  }
  Separation edge;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      btVector3 axis = a.axis[i].cross(b.axis[j]);
      const btScalar length = axis.length();
      if (length < btScalar(1e-3)) continue;
      axis /= length;
      const btScalar along = between.dot(axis);
      const btScalar distance = btFabs(along) - a.extent(axis) - b.extent(axis);
      if (distance > most) return;
      if (distance > edge.distance) edge = {distance, along < 0 ? -axis : axis, i, j};
    }
  }

  if (edge.distance > face.distance + prefer_faces_to_edges) {
    out.normal = -edge.a_to_b;
    cross_edges(a, b, edge, out);
    return add_beside(a, b, face, edge, reach, prefer_face, out);
  }
  int axis_a = 0, axis_b = 0;
  if (find_parallel(a, b, axis_a, axis_b)) {
    const btVector3 towards_b = faces[0].a_to_b + faces[1].a_to_b;
    const Edge one = edge_of(a, axis_a, towards_b), other = edge_of(b, axis_b, -towards_b);
    if (meet_along_edges(one, other, prefer_face, reach, out)) return;
    face = faces[faces[1].distance > faces[0].distance];
  }
  out.normal = -face.a_to_b;
  touch_face(a, b, face, reach, out);
}

}  // namespace ziggurat::physics::contact
