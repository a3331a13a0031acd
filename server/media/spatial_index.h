// SPDX-License-Identifier: MIT
#pragma once
// Points found by place: a uniform grid in a hash table. Built anew in linear time; building and
// asking allocate nothing once sizes repeat. What is found never depends on the grid.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "math/pose.h"

namespace ziggurat::media {

class SpatialIndex {
 public:
  /// @param points   in W [m]; those that are not finite are never found
  /// @param radii    of usual queries, to choose the size of the cells by [m]; may be empty
  void build(std::span<const math::Vector3> points, std::span<const double> radii);
  /// The same with cells of a given size.
  /// @param cell  edge [m], > 0
  void build(std::span<const math::Vector3> points, double cell);

  /// Indices of the points whose distance from `center` is less than `radius`, ascending.
  /// @param first, last  only indices in [first, last) are wanted
  /// @param found  emptied before
  void find(const math::Vector3& center, double radius, std::size_t first, std::size_t last,
            std::vector<std::size_t>& found) const;

  /// The same for the points in the box from `low` to `high`, its surface included.
  void find(const math::Vector3& low, const math::Vector3& high, std::size_t first,
            std::size_t last, std::vector<std::size_t>& found) const;

  double cell() const { return cell_; }  ///< edge of a cell [m]

 private:
  using Cell = std::array<std::int64_t, 3>;

  struct Item {
    math::Vector3 point = math::Vector3::Zero();
    std::uint32_t index;
  };

  double choose_cell(std::span<const math::Vector3> points, std::span<const double> radii);
  Cell cell_of(const math::Vector3& point) const;
  std::size_t bucket_of(const Cell& cell) const;
  template <class Visit>
  void visit(const math::Vector3& low, const math::Vector3& high, Visit look) const;

  double cell_ = 1;
  std::size_t mask_ = 0;                // buckets - 1, buckets a power of two
  std::vector<std::uint32_t> starts_;   // per bucket, into items_; one more at the end
  std::vector<std::uint32_t> buckets_;  // per point
  std::vector<Item> items_;             // by bucket, then by index
  std::vector<double> sample_;          // of choose_cell
};

}  // namespace ziggurat::media
