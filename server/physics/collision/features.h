// SPDX-License-Identifier: MIT
#pragma once
// Faces, edges and extents of convex bodies where they are, for clipping one against another.

#include <variant>

#include "physics/collision/polygon.h"
#include "physics/collision/shapes.h"

namespace ziggurat::physics::contact {

/// A body and its pose in the world.
struct Body {
  std::variant<const Box*, const Cylinder*, const Capsule*, const Hull*> shape;
  btVector3 centre;
  btVector3 axis[3];

  template <class One>
  Body(const One* one, const btTransform& pose) : shape(one), centre(pose.getOrigin()) {
    for (int i = 0; i < 3; ++i) axis[i] = pose.getBasis().getColumn(i);
  }
};

/// Extent of the body from its centre along a unit direction [m].
btScalar extent(const Body& body, const btVector3& direction);

/// Its smallest half extent [m].
btScalar smallest(const Body& body);

/// Flat faces; two that are opposite each other, as those of boxes and cylinders, count once.
int face_count(const Body& body);

/// The outward normal of a face, of two opposite ones the one that looks towards `point`.
btVector3 face_towards(const Body& body, int face, const btVector3& point);

/// Feature of the body that faces a direction: a face, a cap as an octagon, or a line along the
/// side.
Polygon feature(const Body& body, const btVector3& towards);

/// Cuts a polygon to the outline of a face: its edges, or a disc as 16 tangents.
void clip_to_face(Polygon& polygon, const Body& body, int face);

/// An axis and a direction whose cosine is less are nearly at right angles.
inline constexpr btScalar almost_across = btScalar(0.1);

/// An edge, or the axis of a round side, with what is around it.
struct Line {
  btVector3 middle;
  btVector3 direction;       ///< of unit length
  btScalar half_length = 0;  ///< [m]
  btScalar radius = 0;       ///< of the side; 0: an edge [m]
};

/// A round side. False of shapes without.
bool side(const Body& body, Line& line);

/// An edge or side of B that a line on the side of A may lie along. False if there is none.
/// @param on_b  the point of B nearest to A: of parallel edges the one there
bool edge_along(const Body& b, const btVector3& b_to_a, const btVector3& on_b,
                const btVector3& direction, Line& line);

}  // namespace ziggurat::physics::contact
