// SPDX-License-Identifier: MIT
#pragma once
// View of a picture, and its camera.

#include <cstdint>
#include <vector>

#include "math/pose.h"

namespace ziggurat::render {

/// Red, green, blue, 8 bits each (sRGB); rows from top to bottom, without padding.
struct Picture {
  unsigned width = 0, height = 0;  ///< [px]
  std::vector<std::uint8_t> rgb;   ///< width * height * 3
};

/// Layers of a picture besides the visible surfaces.
struct Layers {
  bool rays = false;    ///< State::rays
  bool frusta = false;  ///< what cameras can see, as edges
  bool labels = false;  ///< ids of entities
};

/// A pinhole camera. A point (X, Y, Z) of its frame, Z > 0, is at u = fx X / Z + cx, v = fy Y / Z +
/// cy. (0, 0) is the top left corner of the picture, not the centre of a pixel.
struct View {
  math::Pose camera;  ///< X_WC: +z forward, +x right, +y down in the picture
  math::Vector2 focal_length = math::Vector2::Zero();     ///< fx, fy [px], > 0
  math::Vector2 principal_point = math::Vector2::Zero();  ///< cx, cy [px]
  unsigned width = 0, height = 0;                         ///< [px], > 0
  /// Each pixel is the mean of so many by so many rendered ones, >= 1. Each of these has four
  /// samples for the outlines of things in any case, and tags have more.
  unsigned oversampling = 2;
  Layers layers = {};
};

/// The pose X_WC of a camera at `eye` that looks at `target` and has world's z up in its picture;
/// seen along z, world's y is up. Looks along x if both points are one.
math::Pose look_at(const math::Vector3& eye, const math::Vector3& target);

/// A view with its principal point in the middle.
/// @param opening  full angle between the picture's left and right edge [rad], < pi
View symmetric_view(const math::Pose& camera, double opening, unsigned width, unsigned height);

}  // namespace ziggurat::render
