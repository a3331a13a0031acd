// SPDX-License-Identifier: MIT
#pragma once
// Colours of the arena's floor from a picture.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace ziggurat::scene {

struct Arena;

struct FloorImage {
  unsigned width = 0, height = 0;  ///< [px], at least 1
  std::vector<std::uint8_t> rgb;   ///< three bytes a pixel, rows from top to bottom
};

/// White: all around a picture, too.
inline constexpr std::uint32_t floor_without_image = 0xFFFFFF;

/// Colour of a place as 0xRRGGBB. The picture covers the arena: right is +x, up is +y.
/// @param x, y  in the world [m]
std::uint32_t floor_color(const FloorImage& image, const Arena& arena, double x, double y);

inline constexpr std::size_t most_floor_pixels = std::size_t{16} << 20;

/// A PNG file, or a PPM or PGM file of bytes (P5, P6). Or why it is none: `is …; write …`.
std::variant<FloorImage, std::string> read_floor_image(std::string_view bytes);

}  // namespace ziggurat::scene
