// SPDX-License-Identifier: MIT
#pragma once
// Between our types and Bullet's.

#include <LinearMath/btTransform.h>

#include "math/pose.h"

namespace ziggurat::physics {

inline btVector3 to_bullet(const math::Vector3& v) { return {v.x(), v.y(), v.z()}; }
inline btQuaternion to_bullet(const math::Quaternion& q) { return {q.x(), q.y(), q.z(), q.w()}; }
inline btTransform to_bullet(const math::Pose& pose) {
  return btTransform(to_bullet(pose.orientation), to_bullet(pose.position));
}
inline math::Vector3 from_bullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
inline math::Quaternion from_bullet(const btQuaternion& q) { return {q.w(), q.x(), q.y(), q.z()}; }
inline math::Pose from_bullet(const btTransform& t) {
  return {from_bullet(t.getOrigin()), from_bullet(t.getRotation())};
}

}  // namespace ziggurat::physics
