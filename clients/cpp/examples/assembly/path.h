// SPDX-License-Identifier: MIT
#pragma once
// Shortest ways around obstacles, on a grid (A*).

#include <optional>
#include <span>
#include <vector>

#include "geometry.h"

namespace assembly {

struct Obstacle : Point {
  double hard = 0;  ///< the way should not lead nearer [m]
  double soft = 0;  ///< and had better not lead so near [m]
};

/// The points of a way from near `from` to `to`, which is the last. Nothing if it is farther
/// than 1.8 m in x or y.
std::optional<std::vector<Point>> find_path(const Point& from, const Point& to,
                                            std::span<const Obstacle> obstacles);

}  // namespace assembly
