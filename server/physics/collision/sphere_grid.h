// SPDX-License-Identifier: MIT
#pragma once
// Hierarchical grid of spheres, one level for each power of two of their diameters. A query takes
// the same time for any number of spheres.

#include <LinearMath/btVector3.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <vector>

namespace ziggurat::physics {

class SphereGrid {
 public:
  /// @param index   what visit() is given for it
  /// @param centre  in the world [m]
  /// @param radius  [m]; not finite or 0 and less: it is near everything
  void add(std::size_t index, const btVector3& centre, btScalar radius);

  /// Visits all spheres that touch this one, and some others near it, in no particular order.
  template <class Visit>
  void visit(const btVector3& centre, btScalar radius, Visit visit) const {
    for (const std::size_t index : unbounded_) visit(index);
    for (const auto& [exponent, level] : levels_)
      visit_level(exponent, level, centre, radius, visit);
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct Hash {
    std::size_t operator()(const Cell& cell) const;
  };
  struct Level {
    std::unordered_map<Cell, std::vector<std::size_t>, Hash> cells;
    std::vector<std::size_t> all;
  };
  /// Cells of a level are 2^exponent metres wide, no smaller than the spheres in them.
  static Cell cell_of(const btVector3& place, int exponent);
  static constexpr double most_cells = 1000;  // of a level; beyond, all of its spheres are visited

  template <class Visit>
  static void visit_level(int exponent, const Level& level, const btVector3& centre,
                          btScalar radius, Visit& visit) {
    const btScalar reach = radius + std::ldexp(btScalar{0.5}, exponent);
    const btVector3 around(reach, reach, reach);
    const Cell first = cell_of(centre - around, exponent),
               last = cell_of(centre + around, exponent);
    double cells = 1;
    for (int i = 0; i < 3; ++i) cells *= static_cast<double>(last[i] - first[i] + 1);
    if (!(radius < reach) || cells > most_cells) {
      for (const std::size_t index : level.all) visit(index);
      return;
    }
    for (Cell at = first; at[0] <= last[0]; ++at[0]) {
      for (at[1] = first[1]; at[1] <= last[1]; ++at[1]) {
        for (at[2] = first[2]; at[2] <= last[2]; ++at[2]) {
          const auto found = level.cells.find(at);
          if (found == level.cells.end()) continue;
          for (const std::size_t index : found->second) visit(index);
        }
      }
    }
  }

  std::map<int, Level> levels_;  // by exponent
  std::vector<std::size_t> unbounded_;
};

/// Calls visit(i) once for each i below count, in the order of their numbers with the bits
/// reversed. Bullet's trees of boxes put each new box where it fits best: in a row, one after
/// another, they make a list.
template <class Visit>
void in_bit_reversed_order(std::size_t count, Visit visit) {
  const std::size_t places = std::bit_ceil(count);
  for (std::size_t i = 0, at = 0; i < places && count > 0; ++i) {
    if (at < count) visit(at);
    std::size_t bit = places / 2;
    for (; (at & bit) != 0; bit /= 2) at ^= bit;
    at |= bit;
  }
}

}  // namespace ziggurat::physics
