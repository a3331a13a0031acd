// SPDX-License-Identifier: MIT
#include "world/floor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "math/hash.h"

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

std::variant<std::shared_ptr<const FloorImage>, std::string> floor_image(std::string file) {
  auto read = images::read_image(file);
  if (auto* why = std::get_if<std::string>(&read)) return std::move(*why);
  math::Hash hash;
  hash.add(std::string_view(file));
  return std::make_shared<const FloorImage>(
      FloorImage{std::move(file), std::get<images::Image>(std::move(read)), hash.digest()});
}

std::optional<Color> color_of(const FloorPaint& region, const std::array<double, 2>& place) {
  if (region.image) {
    const images::Rectangle covered{region.center,
                                    {2 * region.half_size[0], 2 * region.half_size[1]}};
    return images::color_at(region.image->image, covered, place[0], place[1]);
  }
  const double x = away(region, place, 0), y = away(region, place, 1);
  const bool covers = region.is_disc ? std::hypot(x, y) <= region.half_size[0]
                                     : x <= region.half_size[0] && y <= region.half_size[1];
  return covers ? std::optional(region.color) : std::nullopt;
}

bool is_valid(const FloorPaint& paint) {
  const auto is_bounded = [](double value) { return std::abs(value) <= largest_floor_length; };
  const auto is_size = [&](double value) { return value > 0 && is_bounded(value); };
  return std::ranges::all_of(paint.center, is_bounded) &&
         std::ranges::all_of(paint.half_size, is_size) && paint.color <= 0xFFFFFF &&
         (!paint.is_disc || paint.half_size[0] == paint.half_size[1]) &&
         (!paint.image || (!paint.is_disc && paint.color == 0));
}

bool paint(std::vector<FloorPaint>& floor, const FloorPaint& region) {
  std::erase_if(floor,
                [&](const FloorPaint& lower) { return region.image || hides(region, lower); });
  if (floor.size() >= most_floor_paints) return false;
  floor.push_back(region);
  return true;
}

const FloorImage* image_on(const std::vector<FloorPaint>& floor) {
  return floor.empty() ? nullptr : floor.front().image.get();
}

std::optional<Color> painted_color(const std::vector<FloorPaint>& floor, double x, double y) {
  for (auto region = floor.rbegin(); region != floor.rend(); ++region) {
    if (const auto color = color_of(*region, {x, y})) return color;
  }
  return std::nullopt;
}

}  // namespace ziggurat::world
