// SPDX-License-Identifier: MIT
#include "physics/collision/sphere_grid.h"

#include <algorithm>

namespace ziggurat::physics {

std::size_t SphereGrid::Hash::operator()(const Cell& cell) const {
  std::uint64_t hash = 0;
  for (const std::int64_t part : cell) {
    hash = (hash ^ static_cast<std::uint64_t>(part)) * 0x9E3779B97F4A7C15U;
    hash ^= hash >> 29;
  }
  return static_cast<std::size_t>(hash);
}

SphereGrid::Cell SphereGrid::cell_of(const btVector3& place, int exponent) {
  constexpr btScalar farthest = 0x1p60;  // [cells]
  Cell cell;
  for (int i = 0; i < 3; ++i) {
    const btScalar at = std::floor(std::ldexp(place[i], -exponent));
    cell[static_cast<std::size_t>(i)] =
        static_cast<std::int64_t>(std::max(-farthest, std::min(at, farthest)));
  }
  return cell;
}

void SphereGrid::add(std::size_t index, const btVector3& centre, btScalar radius) {
  const bool has_place = std::isfinite(radius) && radius > 0 && std::isfinite(centre.length2());
  if (!has_place) return unbounded_.push_back(index);
  const int exponent = std::ilogb(radius) + 2;  // 2^exponent is more than the diameter
  Level& level = levels_[exponent];
  level.cells[cell_of(centre, exponent)].push_back(index);
  level.all.push_back(index);
}

}  // namespace ziggurat::physics
