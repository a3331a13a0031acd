// SPDX-License-Identifier: MIT
#pragma once
// Rotations that follow from turning at a constant rate, exactly.

#include <cmath>

#include "physics/multibody/spatial.h"

namespace ziggurat::dynamics {

/// The rotation by |turn| about turn: the exponential map.
/// @param turn  [rad]
inline Quaternion exponential(const Vector3& turn) {
  const double square = turn.squaredNorm();
  const double angle = std::sqrt(square);
  // sin(a / 2) / a, by its series where the quotient loses digits.
  const double factor = angle < 1e-4 ? 0.5 - square / 48 : std::sin(angle / 2) / angle;
  return {std::cos(angle / 2), factor * turn.x(), factor * turn.y(), factor * turn.z()};
}

/// The rotation matrix of a quaternion that need not be of unit length.
/// @param q  w, x, y, z
inline Matrix3 rotation_matrix(const double* q) {
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  const double s = 2 / (w * w + x * x + y * y + z * z);
  Matrix3 m;
  m << 1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y),  //
      s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x),   //
      s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y);
  return m;
}

}  // namespace ziggurat::dynamics
