// SPDX-License-Identifier: MIT
#pragma once
// The pose of a square tag from its four corners in one image.

#include <ziggurat/ziggurat.h>

#include <array>
#include <optional>

namespace construction {

using Vector = std::array<double, 3>;

struct TagPose {
  Vector centre;  ///< in the camera's frame: x right, y down, z forward [m]
  Vector normal;  ///< outward, of length 1, in the same frame
};

/// Exact for corners without noise.
/// @param corners  in the camera's order: (-,-), (-,+), (+,+), (+,-) of the tag's own x and y
/// @param side     outer edge of the tag [m]
/// @return nothing if the corners are no convex quadrilateral
std::optional<TagPose> tag_pose(const std::array<ziggurat::Camera::Pixel, 4>& corners,
                                const ziggurat::Camera& camera, double side);

}  // namespace construction
