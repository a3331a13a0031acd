// SPDX-License-Identifier: MIT
#include "world/marker.h"

#include <algorithm>
#include <cmath>

namespace ziggurat::world {

bool is_valid(const Marker& marker) {
  const auto is_bounded = [](double value) { return std::abs(value) <= largest_marker_length; };
  const auto is_place = [&](const math::Vector3& place) {
    return std::all_of(place.begin(), place.end(), is_bounded);
  };
  if (!is_place(marker.at) || marker.color > 0xFFFFFF) return false;
  switch (marker.shape) {
    case Marker::Shape::arrow:
      return is_place(marker.to);
    case Marker::Shape::ring:
      return marker.radius > 0 && is_bounded(marker.radius);
    case Marker::Shape::text:
      break;
  }
  return !marker.text.empty() && marker.text.size() <= most_marker_text_bytes;
}

}  // namespace ziggurat::world
