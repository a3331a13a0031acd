// SPDX-License-Identifier: MIT
#pragma once
// Regions of the floor that directors painted.

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "world/color.h"

namespace ziggurat::world {

/// A rectangle along the world's axes, or a disc, in one colour.
struct FloorPaint {
  std::array<double, 2> center{};     ///< x, y [m]
  std::array<double, 2> half_size{};  ///< along x and y [m], > 0; of a disc its radius, twice
  bool is_disc = false;
  Color color = 0;  ///< at most 0xFFFFFF
  bool operator==(const FloorPaint&) const = default;
};

/// Whether a place [m] lies in a region.
bool covers(const FloorPaint& region, const std::array<double, 2>& place);

/// Regions that a floor remembers.
inline constexpr std::size_t most_floor_paints = 10'000;
/// Bound of centres and sizes [m].
inline constexpr double largest_floor_length = 1e6;

/// Whether center, size and color are within their bounds.
bool is_valid(const FloorPaint& paint);

/// Paints a region over others. Those that it hides wholly are forgotten.
/// @param floor  in the order of painting
/// @return       false: there are too many already, and nothing changes
bool paint(std::vector<FloorPaint>& floor, const FloorPaint& region);

/// The colour of a place [m]; none where nothing was painted.
std::optional<Color> painted_color(const std::vector<FloorPaint>& floor, double x, double y);

}  // namespace ziggurat::world
