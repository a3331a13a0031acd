// SPDX-License-Identifier: MIT
#pragma once
// Rigid poses. Frames are right-handed with z up; quaternions are Hamilton, w x y z.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace ziggurat::math {

using Vector2 = Eigen::Vector2d;
using Vector3 = Eigen::Vector3d;
using Quaternion = Eigen::Quaterniond;

/// Pose X_AB of a frame B seen from a frame A: p_A = orientation * p_B + position.
struct Pose {
  Vector3 position = Vector3::Zero();               ///< origin of B in A [m]
  Quaternion orientation = Quaternion::Identity();  ///< rotation from B to A, unit
};

/// Whether a quaternion has length 1, up to what rounding and other programs leave of it.
inline bool is_rotation(const Quaternion& quaternion) {
  return std::abs(quaternion.squaredNorm() - 1) < 1e-6;
}

/// Canonical one of the two quaternions of a rotation. It has w >= 0 and turns by 0 to pi. For a
/// half turn its last component that is not 0 is positive.
inline Quaternion canonical(const Quaternion& q) {
  const double last = q.z() != 0 ? q.z() : q.y() != 0 ? q.y() : q.x();
  const bool is_other = q.w() < 0 || (q.w() == 0 && last < 0);
  return is_other ? Quaternion(-q.coeffs()) : q;
}

/// X_AC from X_AB and X_BC.
inline Pose operator*(const Pose& a_b, const Pose& b_c) {
  return {a_b.position + a_b.orientation * b_c.position, a_b.orientation * b_c.orientation};
}

/// A point given in B, expressed in A [m].
inline Vector3 operator*(const Pose& a_b, const Vector3& point) {
  return a_b.position + a_b.orientation * point;
}

/// X_BA from X_AB.
inline Pose inverse(const Pose& a_b) {
  const Quaternion inverted = a_b.orientation.conjugate();
  return {-(inverted * a_b.position), inverted};
}

/// Heading of a pose in W: of its x axis about z, from the x axis of W [rad].
inline double heading_of(const Pose& pose) {
  const Vector3 ahead = pose.orientation * Vector3::UnitX();
  return std::atan2(ahead.y(), ahead.x());
}

/// Principal axes of an inertia as a rotation; none where the inertia is diagonal already.
Quaternion principal_axes(const Eigen::Matrix3d& inertia);

}  // namespace ziggurat::math
