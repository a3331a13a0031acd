// SPDX-License-Identifier: MIT
#pragma once
// A pinhole camera without distortion: where points of the world stand in its image, and what part
// of the world it can see. +z looks forward, +x to the right, +y down.

#include <array>
#include <optional>

#include "math/pose.h"
#include "world/layout.h"

namespace ziggurat::camera {

/// Tolerance at an edge of the image [px], of the range [m] or of an observable angle [rad]. Points
/// closer than this count as inside, so that the rounding of poses does not decide there.
constexpr double edge = 1e-9;

/// A point in pixels from the image's top left corner, u to the right, v down: real numbers.
/// @param point  in the camera's frame [m], z > 0
math::Vector2 project(const world::CameraLayout& camera, const math::Vector3& point);

/// The same if the camera can see it there: 0 <= u <= width, 0 <= v <= height and
/// near <= z <= far, edges included; otherwise nothing. The line of sight is not checked.
/// @param point  in the camera's frame [m], any
std::optional<math::Vector2> in_view(const world::CameraLayout& camera, const math::Vector3& point);

/// Corners of what a camera can see, as world::Frustum has them.
/// @param pose  X_WC of the camera
std::array<math::Vector3, 8> frustum(const world::CameraLayout& camera, const math::Pose& pose);

/// A box along the world's axes [m], with its surface.
struct Bounds {
  math::Vector3 low = math::Vector3::Zero(), high = math::Vector3::Zero();
};

/// The box that holds all points that in_view() can accept.
/// @param corners  of a frustum [m]
Bounds bounds(const std::array<math::Vector3, 8>& corners);

}  // namespace ziggurat::camera
