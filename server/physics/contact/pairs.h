#pragma once
// contact_points() for pairs of shapes, in one order of the two; find() turns the other round. A
// shape that lacks a function with one of the others does not compile.
//
// All take the poses of the shapes' frames in the world and fill `out` with points no farther apart
// than `reach`.

#include "physics/contact/shapes.h"

namespace ziggurat::physics::contact {

/// What a function needs besides the shapes.
struct Placement {
  const btTransform& a;  ///< pose of A
  const btTransform& b;  ///< pose of B
  btScalar reach;        ///< [m]
};

void contact_points(const Box& a, const HalfSpace& b, const Placement& at, Contacts& out);
void contact_points(const Cylinder& a, const HalfSpace& b, const Placement& at, Contacts& out);
void contact_points(const Sphere& a, const HalfSpace& b, const Placement& at, Contacts& out);
void contact_points(const Capsule& a, const HalfSpace& b, const Placement& at, Contacts& out);
void contact_points(const Hull& a, const HalfSpace& b, const Placement& at, Contacts& out);

void contact_points(const Sphere& a, const Sphere& b, const Placement& at, Contacts& out);
void contact_points(const Sphere& a, const Box& b, const Placement& at, Contacts& out);
void contact_points(const Sphere& a, const Cylinder& b, const Placement& at, Contacts& out);
void contact_points(const Sphere& a, const Capsule& b, const Placement& at, Contacts& out);
void contact_points(const Sphere& a, const Hull& b, const Placement& at, Contacts& out);

void contact_points(const Capsule& a, const Capsule& b, const Placement& at, Contacts& out);

void contact_points(const Box& a, const Box& b, const Placement& at, Contacts& out);

// By GJK and clipping of features:
void contact_points(const Cylinder& a, const Box& b, const Placement& at, Contacts& out);
void contact_points(const Cylinder& a, const Cylinder& b, const Placement& at, Contacts& out);
void contact_points(const Cylinder& a, const Hull& b, const Placement& at, Contacts& out);
void contact_points(const Capsule& a, const Box& b, const Placement& at, Contacts& out);
void contact_points(const Capsule& a, const Cylinder& b, const Placement& at, Contacts& out);
void contact_points(const Capsule& a, const Hull& b, const Placement& at, Contacts& out);
void contact_points(const Hull& a, const Box& b, const Placement& at, Contacts& out);
void contact_points(const Hull& a, const Hull& b, const Placement& at, Contacts& out);

/// Two half-spaces never touch.
inline void contact_points(const HalfSpace&, const HalfSpace&, const Placement&, Contacts&) {}

/// The same contacts seen from the other side: normal turned round, points moved to the
/// surface of what was A.
void swap_sides(Contacts& contacts);

}  // namespace ziggurat::physics::contact
