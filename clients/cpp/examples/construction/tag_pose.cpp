// SPDX-License-Identifier: MIT
#include "tag_pose.h"

#include <cmath>
#include <cstddef>

namespace construction {
namespace {

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double length(const Vector& a) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }

}  // namespace

// A plane is seen through a homography. For a square that fills 0 <= u, v <= 1 of its plane it has
// a closed form (Heckbert 1989). Its columns are the square's two edges and its first corner in the
// camera's frame, up to one scale (Zhang 2000).
std::optional<TagPose> tag_pose(const std::array<ziggurat::Camera::Pixel, 4>& corners,
                                const ziggurat::Camera& camera, double side) {
  std::array<double, 4> x{}, y{};
  for (std::size_t i = 0; i < 4; ++i) {
    x[i] = (corners[i][0] - camera.principal_point()[0]) / camera.focal_length()[0];
    y[i] = (corners[i][1] - camera.principal_point()[1]) / camera.focal_length()[1];
  }
  // u runs along the tag's x: from the first corner to the fourth; v from the first to the second.
  const double dx1 = x[3] - x[2], dx2 = x[1] - x[2], sx = x[0] - x[3] + x[2] - x[1];
  const double dy1 = y[3] - y[2], dy2 = y[1] - y[2], sy = y[0] - y[3] + y[2] - y[1];
  const double determinant = dx1 * dy2 - dx2 * dy1;
  if (std::abs(determinant) < 1e-12) return std::nullopt;
  const double g = (sx * dy2 - dx2 * sy) / determinant;
  const double h = (dx1 * sy - sx * dy1) / determinant;
  const Vector edge_u = {x[3] - x[0] + g * x[3], y[3] - y[0] + g * y[3], g};
  const Vector edge_v = {x[1] - x[0] + h * x[1], y[1] - y[0] + h * y[1], h};
  const double scale = 2 * side / (length(edge_u) + length(edge_v));
  const Vector first = {x[0], y[0], 1};
  TagPose pose{};
  for (std::size_t i = 0; i < 3; ++i) {
    pose.centre[i] = scale * (first[i] + 0.5 * edge_u[i] + 0.5 * edge_v[i]);
  }
  pose.normal = cross(edge_u, edge_v);
  const double size = length(pose.normal);
  if (size == 0 || pose.centre[2] <= 0) return std::nullopt;
  for (double& part : pose.normal) part /= size;
  return pose;
}

}  // namespace construction
