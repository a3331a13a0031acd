// SPDX-License-Identifier: MIT
#include "world/floor.h"

#include <algorithm>
#include <cmath>

namespace ziggurat::world {
namespace {

double away(const FloorPaint& a, const std::array<double, 2>& place, std::size_t axis) {
  return std::abs(place[axis] - a.center[axis]);
}

bool hides(const FloorPaint& upper, const FloorPaint& lower) {
  const double x = away(upper, lower.center, 0), y = away(upper, lower.center, 1);
  if (!upper.is_disc)
    return x + lower.half_size[0] <= upper.half_size[0] &&
           y + lower.half_size[1] <= upper.half_size[1];
  if (lower.is_disc) return std::hypot(x, y) + lower.half_size[0] <= upper.half_size[0];
  return std::hypot(x + lower.half_size[0], y + lower.half_size[1]) <= upper.half_size[0];
}

}  // namespace

bool covers(const FloorPaint& region, const std::array<double, 2>& place) {
  const double x = away(region, place, 0), y = away(region, place, 1);
  if (region.is_disc) return std::hypot(x, y) <= region.half_size[0];
  return x <= region.half_size[0] && y <= region.half_size[1];
}

bool is_valid(const FloorPaint& paint) {
  const auto is_bounded = [](double value) { return std::abs(value) <= largest_floor_length; };
  const auto is_size = [&](double value) { return value > 0 && is_bounded(value); };
  return std::ranges::all_of(paint.center, is_bounded) &&
         std::ranges::all_of(paint.half_size, is_size) && paint.color <= 0xFFFFFF &&
         (!paint.is_disc || paint.half_size[0] == paint.half_size[1]);
}

bool paint(std::vector<FloorPaint>& floor, const FloorPaint& region) {
  std::erase_if(floor, [&](const FloorPaint& lower) { return hides(region, lower); });
  if (floor.size() >= most_floor_paints) return false;
  floor.push_back(region);
  return true;
}

std::optional<Color> painted_color(const std::vector<FloorPaint>& floor, double x, double y) {
  const auto top = std::find_if(floor.rbegin(), floor.rend(), [&](const FloorPaint& region) {
    return covers(region, {x, y});
  });
  return top == floor.rend() ? std::nullopt : std::optional(top->color);
}

}  // namespace ziggurat::world
