// SPDX-License-Identifier: MIT
#pragma once
// Letters for labels in pictures: five by seven points each.

#include <array>
#include <cstdint>

namespace ziggurat::render {

constexpr unsigned glyph_width = 5, glyph_height = 7;  // [points]

/// Rows from top to bottom; bit 4 is the left point.
using Glyph = std::array<std::uint8_t, glyph_height>;

/// @param code  a character of Unicode; those beyond ASCII are a frame
const Glyph& glyph_of(char32_t code);

}  // namespace ziggurat::render
