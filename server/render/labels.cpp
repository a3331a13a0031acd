// SPDX-License-Identifier: MIT
#include "render/labels.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "render/font.h"

namespace ziggurat::render {
namespace {

constexpr unsigned pixels_per_point = 360;  // a point is as high as the picture by this, at least 1
constexpr int advance = glyph_width + 1;    // [points]

/// The characters of UTF-8; a byte that is none counts as one.
std::u32string characters(std::string_view text) {
  std::u32string all;
  for (const char each : text) {
    const auto byte = static_cast<unsigned char>(each);
    const bool continues = byte >= 0x80 && byte < 0xc0;
    if (!continues) all += byte < 0x80 ? static_cast<char32_t>(byte) : U'\ufffd';
  }
  return all;
}

void fill(Picture& picture, int left, int top, int side, std::uint8_t grey) {
  const int right = std::min(left + side, static_cast<int>(picture.width));
  const int bottom = std::min(top + side, static_cast<int>(picture.height));
  for (int y = std::max(top, 0); y < bottom; ++y) {
    for (int x = std::max(left, 0); x < right; ++x) {
      std::uint8_t* pixel =
          &picture
               .rgb[3 * (static_cast<std::size_t>(y) * picture.width + static_cast<unsigned>(x))];
      pixel[0] = pixel[1] = pixel[2] = grey;
    }
  }
}

void draw(const std::u32string& text, int left, int top, int scale, Picture& picture) {
  constexpr std::uint8_t dark = 24, light = 250;
  const auto each_point = [&](auto paint) {
    for (std::size_t i = 0; i < text.size(); ++i) {
      const Glyph& glyph = glyph_of(text[i]);
      for (int row = 0; row < static_cast<int>(glyph_height); ++row) {
        for (int column = 0; column < static_cast<int>(glyph_width); ++column) {
          if (!((glyph[static_cast<std::size_t>(row)] >> (4 - column)) & 1)) continue;
          paint(left + scale * (static_cast<int>(i) * advance + column), top + scale * row);
        }
      }
    }
  };
  each_point([&](int x, int y) { fill(picture, x - 1, y - 1, scale + 2, dark); });
  each_point([&](int x, int y) { fill(picture, x, y, scale, light); });
}

}  // namespace

void draw_labels(std::span<Label> labels, Picture& picture) {
  std::ranges::stable_sort(labels, std::ranges::greater(), &Label::depth);
  const int scale = std::max(1, static_cast<int>(picture.height / pixels_per_point));
  for (const Label& label : labels) {
    const std::u32string text = characters(label.text);
    const int width = scale * (static_cast<int>(text.size()) * advance - 1);
    const int left = static_cast<int>(std::floor(label.u)) - width / 2;
    const int top =
        static_cast<int>(std::floor(label.v)) - scale * (static_cast<int>(glyph_height) + 1);
    draw(text, left, top, scale, picture);
  }
}

}  // namespace ziggurat::render
