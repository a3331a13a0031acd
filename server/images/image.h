// SPDX-License-Identifier: MIT
#pragma once
// Images from files, and the colours of places that they cover.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace ziggurat::images {

struct Image {
  unsigned width = 0, height = 0;  ///< [px], at least 1
  std::vector<std::uint8_t> rgb;   ///< three bytes a pixel, rows from top to bottom
};

/// Rectangle along the world's axes that an image covers: its right is +x, its top +y.
struct Rectangle {
  std::array<double, 2> center{};  ///< x, y [m]
  std::array<double, 2> size{};    ///< along x and y [m], > 0
};

/// Colour of a place as 0xRRGGBB; none outside of the rectangle.
/// @param x, y  in the world [m]
std::optional<std::uint32_t> color_at(const Image& image, const Rectangle& covered, double x,
                                      double y);

inline constexpr std::size_t most_pixels = std::size_t{16} << 20;

/// A PNG file, or a PPM or PGM file of bytes (P5, P6). Or why it is none: `is …; write …`.
std::variant<Image, std::string> read_image(std::string_view bytes);

}  // namespace ziggurat::images
