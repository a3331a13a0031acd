// SPDX-License-Identifier: MIT
#pragma once
// contact_points() for pairs of shapes, in one order of the two; find() turns the other round. A
// shape that lacks a function with one of the others does not compile.
//
// All take the poses of the shapes' frames in the world and fill `out` with points no farther apart
// than `reach`.

#include "physics/collision/features.h"

namespace ziggurat::physics::contact {

/// Poses and options of a pair of shapes.
struct PosedPair {
  const btTransform& a;  ///< pose of A
  const btTransform& b;  ///< pose of B
  btScalar reach;        ///< [m]
  Support support = Support::face;
  btScalar useful = BT_LARGE_FLOAT;  ///< see find() [m]
};

void contact_points(const Box& a, const HalfSpace& b, const PosedPair& at, Manifold& out);
void contact_points(const Cylinder& a, const HalfSpace& b, const PosedPair& at, Manifold& out);
void contact_points(const Sphere& a, const HalfSpace& b, const PosedPair& at, Manifold& out);
void contact_points(const Capsule& a, const HalfSpace& b, const PosedPair& at, Manifold& out);
void contact_points(const Hull& a, const HalfSpace& b, const PosedPair& at, Manifold& out);

void contact_points(const Sphere& a, const Sphere& b, const PosedPair& at, Manifold& out);
void contact_points(const Sphere& a, const Box& b, const PosedPair& at, Manifold& out);
void contact_points(const Sphere& a, const Cylinder& b, const PosedPair& at, Manifold& out);
void contact_points(const Sphere& a, const Capsule& b, const PosedPair& at, Manifold& out);
void contact_points(const Sphere& a, const Hull& b, const PosedPair& at, Manifold& out);

void contact_points(const Capsule& a, const Capsule& b, const PosedPair& at, Manifold& out);

void contact_points(const Box& a, const Box& b, const PosedPair& at, Manifold& out);

/// Shapes with flat faces or straight sides, which GJK and clipping of features treats. The rank of
/// A is at most that of B.
template <class Any>
inline constexpr int clipping_rank = -1;
template <>
inline constexpr int clipping_rank<Capsule> = 0;
template <>
inline constexpr int clipping_rank<Cylinder> = 1;
template <>
inline constexpr int clipping_rank<Hull> = 2;
template <>
inline constexpr int clipping_rank<Box> = 3;

void clipped_contacts(const Body& a, const Body& b, const PosedPair& at, Manifold& out);

/// A shape that may be B where A is the other.
template <class B, class A>
concept ClippedBy = clipping_rank<A>
>= 0 && clipping_rank<A> <= clipping_rank<B>;

/// Pairs of these that have no function of their own above.
template <class A, ClippedBy<A> B>
void contact_points(const A& a, const B& b, const PosedPair& at, Manifold& out) {
  clipped_contacts({&a, at.a}, {&b, at.b}, at, out);
}

/// Two half-spaces never touch.
inline void contact_points(const HalfSpace&, const HalfSpace&, const PosedPair&, Manifold&) {}

/// The same contacts seen from the other side: normal turned round, points moved to the
/// surface of what was A.
void swap_sides(Manifold& contacts);

}  // namespace ziggurat::physics::contact
