// SPDX-License-Identifier: MIT
#include "physics/collision/polygon.h"

#include <algorithm>

namespace ziggurat::physics::contact {

void clip(Polygon& polygon, const btVector3& normal, btScalar offset) {
  Polygon kept;
  const int edges = polygon.count > 2 ? polygon.count : polygon.count - 1;
  for (int i = 0; i < polygon.count; ++i) {
    const btVector3& from = polygon.vertices[i];
    const btScalar beyond_from = normal.dot(from) - offset;
    if (beyond_from <= 0) kept.add(from);
    if (i >= edges) continue;
    const btVector3& to = polygon.vertices[(i + 1) % polygon.count];
    const btScalar beyond_to = normal.dot(to) - offset;
    if ((beyond_from < 0 && beyond_to > 0) || (beyond_from > 0 && beyond_to < 0)) {
      kept.add(from + (to - from) * (beyond_from / (beyond_from - beyond_to)));
    }
  }
  polygon.count = kept.count;
  std::copy_n(kept.vertices.begin(), kept.count, polygon.vertices.begin());
}

}  // namespace ziggurat::physics::contact
