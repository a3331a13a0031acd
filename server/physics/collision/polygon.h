// SPDX-License-Identifier: MIT
#pragma once
// A small convex polygon in space and its clipping by half-spaces.

#include <LinearMath/btVector3.h>

#include <array>

namespace ziggurat::physics::contact {

struct Polygon {
  static constexpr int capacity = 96;
  int count = 0;
  std::array<btVector3, capacity> vertices;

  void add(const btVector3& vertex) {
    if (count < capacity) vertices[count++] = vertex;
  }
};

/// Cuts away what lies beyond the plane normal . x = offset. A segment (two vertices) is
/// clipped as a segment.
void clip(Polygon& polygon, const btVector3& normal, btScalar offset);

}  // namespace ziggurat::physics::contact
