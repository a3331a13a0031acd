// SPDX-License-Identifier: MIT
#pragma once
// Bullet's values in an archive.

#include <LinearMath/btTransform.h>

#include "math/archive.h"

namespace ziggurat::math {

inline void archive_fields(Archive& archive, btVector3& vector) {
  Vector3 copy(vector.x(), vector.y(), vector.z());
  archive("", copy);
  vector.setValue(copy.x(), copy.y(), copy.z());
}

inline void archive_fields(Archive& archive, btTransform& transform) {
  for (int row = 0; row < 3; ++row) archive("", transform.getBasis()[row]);
  archive("", transform.getOrigin());
}

}  // namespace ziggurat::math
