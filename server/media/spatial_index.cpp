// SPDX-License-Identifier: MIT
#include "media/spatial_index.h"

#include <algorithm>
#include <cmath>

namespace ziggurat::media {
namespace {

using math::Vector3;

constexpr std::size_t sample_size = 1024;
constexpr double smallest_cell = 1e-6;  // [m]
constexpr double farthest_cell = 4e18;  // cells are counted in 64 bits

/// Every stride-th value, sorted.
template <class Get>
void sample(std::size_t count, Get get, std::vector<double>& out) {
  out.clear();
  const std::size_t stride = (count + sample_size - 1) / sample_size;
  for (std::size_t i = 0; i < count; i += std::max<std::size_t>(stride, 1)) {
    const double value = get(i);
    if (std::isfinite(value)) out.push_back(value);
  }
  std::ranges::sort(out);
}

/// Edge of the cell that holds one point on average, where most of them are; extents [m].
double spacing(std::array<double, 3> extents, double count) {
  std::ranges::sort(extents, std::greater<>());
  double measure = 1, edge = 0;
  for (int dimension = 1; dimension <= 3; ++dimension) {
    if (dimension > 1 && extents[dimension - 1] <= edge) break;  // flat: thinner than a cell
    measure *= extents[dimension - 1];
    edge = std::pow(measure / count, 1.0 / dimension);
  }
  return edge;
}

}  // namespace

double SpatialIndex::choose_cell(std::span<const Vector3> points, std::span<const double> radii) {
  // The middle of the points decides, so that a few that are far away change nothing.
  std::array<double, 3> extents{};
  for (int axis = 0; axis < 3; ++axis) {
    sample(
        points.size(), [&](std::size_t i) { return points[i][axis]; }, sample_);
    if (sample_.empty()) continue;
    const std::size_t tenth = sample_.size() / 10;
    extents[axis] = sample_[sample_.size() - 1 - tenth] - sample_[tenth];
  }
  const double apart = spacing(extents, 0.8 * static_cast<double>(points.size()) + 1);
  sample(
      radii.size(), [&](std::size_t i) { return radii[i]; }, sample_);
  const double usual = sample_.empty() ? 0 : sample_[sample_.size() / 2];
  return std::max({apart, usual, smallest_cell});
}

SpatialIndex::Cell SpatialIndex::cell_of(const Vector3& point) const {
  Cell cell;
  for (int i = 0; i < 3; ++i) {
    cell[i] = static_cast<std::int64_t>(
        std::clamp(std::floor(point[i] / cell_), -farthest_cell, farthest_cell));
  }
  return cell;
}

std::size_t SpatialIndex::bucket_of(const Cell& cell) const {
  // Cells in a row along x are neighbours in memory.
  std::uint64_t mix = static_cast<std::uint64_t>(cell[1]) * 0x9E3779B97F4A7C15ULL +
                      static_cast<std::uint64_t>(cell[2]) * 0xC2B2AE3D27D4EB4FULL;
  mix ^= mix >> 29;
  mix *= 0xBF58476D1CE4E5B9ULL;
  mix ^= mix >> 32;
  return (mix + static_cast<std::uint64_t>(cell[0])) & mask_;
}

void SpatialIndex::build(std::span<const Vector3> points, std::span<const double> radii) {
  build(points, choose_cell(points, radii));
}

void SpatialIndex::build(std::span<const Vector3> points, double cell) {
  cell_ = std::max(cell, smallest_cell);
  std::size_t buckets = 1;
  while (buckets < points.size()) buckets *= 2;
  mask_ = buckets - 1;
  starts_.assign(buckets + 1, 0);
  buckets_.resize(points.size());
  std::size_t finite = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) continue;
    buckets_[i] = static_cast<std::uint32_t>(bucket_of(cell_of(points[i])));
    ++starts_[buckets_[i]];
    ++finite;
  }
  // Ends first; filling from the back turns them into starts and keeps ascending indices.
  for (std::size_t b = 1; b <= buckets; ++b) starts_[b] += starts_[b - 1];
  items_.resize(finite);
  for (std::size_t i = points.size(); i-- > 0;) {
    if (!points[i].allFinite()) continue;
    items_[--starts_[buckets_[i]]] = {points[i], static_cast<std::uint32_t>(i)};
  }
}

/// Calls look(item) for every item of the cells that a box touches: once, or more often where
/// cells share a bucket. A box of more cells than there are items gets all items.
template <class Visit>
void SpatialIndex::visit(const Vector3& low_point, const Vector3& high_point, Visit look) const {
  const Cell low = cell_of(low_point), high = cell_of(high_point);
  double cells = 1;
  for (int i = 0; i < 3; ++i) cells *= static_cast<double>(high[i] - low[i]) + 1;
  if (cells > static_cast<double>(items_.size())) {
    for (const Item& item : items_) look(item);
    return;
  }
  Cell cell;
  for (cell[2] = low[2]; cell[2] <= high[2]; ++cell[2]) {
    for (cell[1] = low[1]; cell[1] <= high[1]; ++cell[1]) {
      for (cell[0] = low[0]; cell[0] <= high[0]; ++cell[0]) {
        const std::size_t bucket = bucket_of(cell);
        for (std::size_t i = starts_[bucket]; i < starts_[bucket + 1]; ++i) look(items_[i]);
      }
    }
  }
}

namespace {

/// Cells that share a bucket bring its items twice.
void tidy(std::vector<std::size_t>& found) {
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
}

}  // namespace

void SpatialIndex::find(const Vector3& center, double radius, std::size_t first, std::size_t last,
                        std::vector<std::size_t>& found) const {
  found.clear();
  if (items_.empty() || !center.allFinite() || !(radius > 0)) return;
  const Vector3 reach = Vector3::Constant(radius);
  visit(center - reach, center + reach, [&](const Item& item) {
    if (item.index < first || item.index >= last) return;
    if ((item.point - center).norm() < radius) found.push_back(item.index);
  });
  tidy(found);
}

void SpatialIndex::find(const Vector3& low, const Vector3& high, std::size_t first,
                        std::size_t last, std::vector<std::size_t>& found) const {
  found.clear();
  if (items_.empty() || low.hasNaN() || high.hasNaN()) return;
  visit(low, high, [&](const Item& item) {
    if (item.index < first || item.index >= last) return;
    if ((item.point.array() < low.array()).any() || (item.point.array() > high.array()).any()) {
      return;
    }
    found.push_back(item.index);
  });
  tidy(found);
}

}  // namespace ziggurat::media
