// SPDX-License-Identifier: MIT
#pragma once
// Markers: arrows, rings and texts that robots draw for people. Physics and sensors know nothing of
// them.

#include <cstddef>
#include <cstdint>
#include <string>

#include "math/pose.h"
#include "world/color.h"

namespace ziggurat::world {

/// A marker, shown for one tick.
struct Marker {
  enum class Shape : std::uint8_t { arrow, ring, text };
  std::size_t robot = 0;  ///< into Layout::robots
  Shape shape = Shape::arrow;
  math::Vector3 at = math::Vector3::Zero();  ///< start of an arrow, centre of a ring, place of a
                                             ///< text, in the frame of the robot's origin [m]
  math::Vector3 to = math::Vector3::Zero();  ///< end of an arrow, likewise [m]
  double radius = 0;                         ///< of a ring, which lies in the xy plane [m], > 0
  Color color = 0;                           ///< at most 0xFFFFFF
  std::string text;                          ///< not empty, any bytes
};

/// Markers of a robot at a tick.
inline constexpr std::size_t most_markers_per_robot = 1000;
inline constexpr std::size_t most_marker_text_bytes = 100;
/// Bound of coordinates and radii [m].
inline constexpr double largest_marker_length = 1e6;

/// Whether places, radius, text and color are within their bounds.
bool is_valid(const Marker& marker);

}  // namespace ziggurat::world
