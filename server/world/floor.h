// SPDX-License-Identifier: MIT
#pragma once
// Regions of the floor that directors painted, and images that they laid on it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "images/image.h"
#include "world/color.h"

namespace ziggurat::world {

/// An image for the floor.
struct FloorImage {
  std::string file;  ///< its bytes
  images::Image image;
  std::uint64_t digest = 0;  ///< of the file
};

/// The image in a file's bytes. Or why there is none: `is …; write …`.
std::variant<std::shared_ptr<const FloorImage>, std::string> floor_image(std::string file);

/// A rectangle along the world's axes, or a disc, in one colour; or a rectangle with an image.
struct FloorPaint {
  std::array<double, 2> center{};     ///< x, y [m]
  std::array<double, 2> half_size{};  ///< along x and y [m], > 0; of a disc its radius, twice
  bool is_disc = false;
  Color color = 0;                                    ///< at most 0xFFFFFF; 0 with an image
  std::shared_ptr<const FloorImage> image = nullptr;  ///< null: one colour
  bool operator==(const FloorPaint&) const = default;
};

/// The colour that a region has at a place [m]; none where it does not cover it.
std::optional<Color> color_of(const FloorPaint& region, const std::array<double, 2>& place);

/// Images of a Direction, and bytes of one.
inline constexpr std::size_t most_floor_images = 1, longest_floor_image = std::size_t{2} << 20;
/// Regions that a floor remembers.
inline constexpr std::size_t most_floor_paints = 10'000;
/// Bound of centres and sizes [m].
inline constexpr double largest_floor_length = 1e6;

/// Whether center, size and color are within their bounds, and an image is no disc.
bool is_valid(const FloorPaint& paint);

/// Paints a region over others, and forgets those that it hides wholly; an image hides all.
/// @param floor  in the order of painting
/// @return       false: there are too many already, and nothing changes
bool paint(std::vector<FloorPaint>& floor, const FloorPaint& region);

/// The image that lies on a floor; null: there is none.
const FloorImage* image_on(const std::vector<FloorPaint>& floor);

/// The colour of a place [m]; none where nothing was painted.
std::optional<Color> painted_color(const std::vector<FloorPaint>& floor, double x, double y);

}  // namespace ziggurat::world
