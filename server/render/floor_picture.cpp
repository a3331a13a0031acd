// SPDX-License-Identifier: MIT
#include "render/floor_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ziggurat::render {
namespace {

constexpr double longest_side = 1024;  // [px]

/// Pixels of one axis.
struct Axis {
  double low, step;  // [m]
  unsigned count;

  double center(unsigned i) const { return low + (i + 0.5) * step; }
  /// The first pixel at or behind a place.
  unsigned behind(double place) const {
    const double at = std::ceil((place - low) / step - 0.5);
    return static_cast<unsigned>(std::clamp(at, 0.0, static_cast<double>(count)));
  }
};

Axis axis_of(const Model& model, Eigen::Index i) {
  const double size = 2 * model.arena_half_size[i];
  const double longest = 2 * model.arena_half_size.maxCoeff();
  const auto count =
      static_cast<unsigned>(std::max(1.0, std::round(longest_side * size / longest)));
  return {model.arena_center[i] - size / 2, size / count, count};
}

void set(std::uint8_t* pixel, std::uint32_t color) {
  pixel[0] = static_cast<std::uint8_t>(color >> 16);
  pixel[1] = static_cast<std::uint8_t>(color >> 8);
  pixel[2] = static_cast<std::uint8_t>(color);
  pixel[3] = 255;
}

}  // namespace

FloorPicture floor_picture(const Model& model, const std::vector<world::FloorPaint>& painted) {
  const Axis x = axis_of(model, 0), y = axis_of(model, 1);
  FloorPicture picture{x.count, y.count, {}, {}};
  for (std::size_t i = 0; i < picture.light.size(); ++i) {
    picture.light[i] = static_cast<float>(std::pow(static_cast<double>(i) / 255, 2.2));
  }
  picture.rgba.resize(std::size_t{4} * x.count * y.count);
  const auto pixel = [&](unsigned column, unsigned row) {
    return &picture.rgba[4 * (std::size_t{row} * x.count + column)];
  };
  const images::Rectangle ground{{model.arena_center.x(), model.arena_center.y()},
                                 {2 * model.arena_half_size.x(), 2 * model.arena_half_size.y()}};
  for (unsigned row = 0; model.floor_image && row < y.count; ++row) {
    for (unsigned column = 0; column < x.count; ++column)
      if (const auto color =
              images::color_at(*model.floor_image, ground, x.center(column), y.center(row)))
        set(pixel(column, row), *color);
  }
  for (const world::FloorPaint& region : painted) {
    const auto [cx, cy] = region.center;
    const unsigned right = x.behind(cx + region.half_size[0]);
    const unsigned top = y.behind(cy + region.half_size[1]);
    for (unsigned row = y.behind(cy - region.half_size[1]); row < top; ++row) {
      for (unsigned column = x.behind(cx - region.half_size[0]); column < right; ++column) {
        if (const auto color = color_of(region, {x.center(column), y.center(row)}))
          set(pixel(column, row), *color);
      }
    }
  }
  return picture;
}

}  // namespace ziggurat::render
