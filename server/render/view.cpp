// SPDX-License-Identifier: MIT
#include "render/view.h"

#include <cmath>

namespace ziggurat::render {

math::Pose look_at(const math::Vector3& eye, const math::Vector3& target) {
  const math::Vector3 between = target - eye;
  const double distance = between.norm();
  const math::Vector3 forward =
      distance > 0 ? math::Vector3(between / distance) : math::Vector3::UnitX();
  math::Vector3 right = forward.cross(math::Vector3::UnitZ());
  if (right.norm() < 1e-9) right = math::Vector3::UnitX();
  right.normalize();
  Eigen::Matrix3d axes;
  axes << right, forward.cross(right), forward;
  return {eye, math::Quaternion(axes)};
}

View symmetric_view(const math::Pose& camera, double opening, unsigned width, unsigned height) {
  const double focal_length = 0.5 * width / std::tan(0.5 * opening);
  return {camera, {focal_length, focal_length}, {0.5 * width, 0.5 * height}, width, height};
}

}  // namespace ziggurat::render
