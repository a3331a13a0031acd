// SPDX-License-Identifier: MIT
#pragma once
// Convex polygons in a picture, and the samples that they cover. "px" are rendered pixels here, as
// in shading.h.

#include <array>
#include <cstdint>

namespace ziggurat::render {

/// Depth on a plane: value at (x, y) [px] is a x + b y + c.
struct DepthPlane {
  double a = 0, b = 0, c = 0;
  double at(double x, double y) const { return a * x + b * y + c; }
};

/// Places of the four samples in a pixel [px], on a rotated grid.
constexpr std::array<double, 4> sample_x{0.375, 0.875, 0.125, 0.625};
constexpr std::array<double, 4> sample_y{0.125, 0.375, 0.625, 0.875};

/// A convex polygon in the picture, in front of the camera.
struct Polygon {
  /// An edge from its upper end (x, top) down to `bottom`; slope is dx / dy. Horizontal ones are
  /// left out.
  struct Edge {
    double x, top, bottom, slope;
  };
  std::array<Edge, 6> edges;
  unsigned count = 0;
  double top = 0, bottom = 0;  ///< [px]
  DepthPlane depth;
  std::uint32_t surface = 0;
};

/// Pixels of a row, from `begin` to before `end`.
struct Stretch {
  unsigned begin, end;
};

/// The first pixel whose sample at `shift` is at or behind a place, within the picture.
inline unsigned pixel_from(double place, double shift, unsigned width) {
  const double at = place - shift;
  if (!(at > 0)) return 0;
  if (at >= width) return width;
  const auto below = static_cast<unsigned>(at);
  return below + (below < at ? 1 : 0);
}

/// The pixels whose samples in a line a polygon covers. Polygons that share an edge leave no gap
/// and share no sample.
/// @param y  of the line [px];  @param shift  of the samples in their pixels [px]
inline Stretch covered(const Polygon& polygon, double y, double shift, unsigned width) {
  double left = 1e30, right = -1e30;
  for (unsigned i = 0; i < polygon.count; ++i) {
    const Polygon::Edge& edge = polygon.edges[i];
    if (!(edge.top <= y && y < edge.bottom)) continue;
    const double x = edge.x + (y - edge.top) * edge.slope;
    left = x < left ? x : left;
    right = x > right ? x : right;
  }
  if (!(left < right)) return {0, 0};
  return {pixel_from(left, shift, width), pixel_from(right, shift, width)};
}

}  // namespace ziggurat::render
