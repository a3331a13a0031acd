// SPDX-License-Identifier: MIT
#include "camera/projection.h"

namespace ziggurat::camera {

using math::Vector2;
using math::Vector3;

Vector2 project(const world::CameraLayout& camera, const Vector3& point) {
  return Vector2(camera.focal_length.x() * point.x() / point.z() + camera.principal_point.x(),
                 camera.focal_length.y() * point.y() / point.z() + camera.principal_point.y());
}

std::optional<Vector2> in_view(const world::CameraLayout& camera, const Vector3& point) {
  // Each comparison is false for a value that is not a number: such a point is never seen.
  if (!(point.z() >= camera.near - edge && point.z() <= camera.far + edge && point.z() > 0)) {
    return std::nullopt;
  }
  const Vector2 pixel = project(camera, point);
  for (int axis = 0; axis < 2; ++axis) {
    if (!(pixel[axis] >= -edge && pixel[axis] <= camera.resolution[axis] + edge)) {
      return std::nullopt;
    }
  }
  return pixel;
}

std::array<Vector3, 8> frustum(const world::CameraLayout& camera, const math::Pose& pose) {
  const Vector2 size(camera.resolution[0], camera.resolution[1]);
  const Vector2 first = -camera.principal_point.cwiseQuotient(camera.focal_length);
  const Vector2 last = (size - camera.principal_point).cwiseQuotient(camera.focal_length);
  std::array<Vector3, 8> corners;
  std::size_t i = 0;
  for (const double z : {camera.near, camera.far}) {
    for (const auto& [x, y] : {std::pair(first.x(), first.y()), std::pair(last.x(), first.y()),
                               std::pair(last.x(), last.y()), std::pair(first.x(), last.y())}) {
      corners[i++] = pose * Vector3(x * z, y * z, z);
    }
  }
  return corners;
}

Bounds bounds(const std::array<Vector3, 8>& corners) {
  Bounds box{corners[0], corners[0]};
  for (const Vector3& corner : corners) {
    box.low = box.low.cwiseMin(corner);
    box.high = box.high.cwiseMax(corner);
  }
  // A margin for rounding, and for `edge`.
  const double margin = 1e-6 + 1e-9 * (box.high - box.low).maxCoeff();
  box.low.array() -= margin;
  box.high.array() += margin;
  return box;
}

}  // namespace ziggurat::camera
