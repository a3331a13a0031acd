// Box against box: separating axes with signed distance, then the incident face clipped
// against the reference face (S. Gottschalk 1996 for the axes; the clipping is Sutherland and
// Hodgman's). Boxes that overlap always get a contact. Of those that are apart, two that pass
// diagonally may get none, as the clipped face is empty: so blocks of a lattice, which touch their
// diagonal neighbours along an edge, can slide past them.

#include "physics/contact/pairs.h"
#include "physics/contact/polygon.h"

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
                const OrientedBox& incident, bool reference_is_a, btScalar reach, Contacts& out) {
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
                 Contacts& out) {
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

}  // namespace

void contact_points(const Box& box_a, const Box& box_b, const Placement& at, Contacts& out) {
  const auto& [pose_a, pose_b, reach, support, useful] = at;
  const OrientedBox a(box_a, pose_a), b(box_b, pose_b);
  const btVector3 between = b.centre - a.centre;
  // Preferring A's faces, then B's, then edges keeps resting contacts from flickering.
  const btScalar smallest = btMin(a.half[a.half.minAxis()], b.half[b.half.minAxis()]);
  const btScalar prefer_face = btScalar(1e-3) * smallest, prefer_faces_to_edges = 5 * prefer_face;
  const btScalar most = btMin(reach, useful + 10 * prefer_face);  // the axis that is taken

  Separation face;
  for (int i = 0; i < 6; ++i) {
    const btVector3& axis = i < 3 ? a.axis[i] : b.axis[i - 3];
    const btScalar along = between.dot(axis);
    const btScalar own = i < 3 ? a.half[i] : b.half[i - 3];
    const btScalar distance = btFabs(along) - own - (i < 3 ? b.extent(axis) : a.extent(axis));
    if (distance > most) return;
    if (distance > face.distance + (i < 3 ? 0 : prefer_face)) {
      face = {distance, along < 0 ? -axis : axis, i < 3 ? i : -1, i < 3 ? -1 : i - 3};
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
  } else if (face.axis_a >= 0) {
    out.normal = -face.a_to_b;
    clip_faces(a, face.axis_a, face.a_to_b, b, true, reach, out);
  } else {
    out.normal = -face.a_to_b;
    clip_faces(b, face.axis_b, -face.a_to_b, a, false, reach, out);
  }
}

}  // namespace ziggurat::physics::contact
