// SPDX-License-Identifier: MIT
#include "media/spatial_index.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace ziggurat::media {
namespace {

using math::Vector3;

std::vector<std::size_t> search(const std::vector<Vector3>& points, const Vector3& center,
                                double radius) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if ((points[i] - center).norm() < radius) found.push_back(i);
  }
  return found;
}

void expect_same_as_search(const std::vector<Vector3>& points, const std::vector<double>& radii) {
  SpatialIndex index;
  index.build(points, radii);
  std::vector<std::size_t> found;
  std::size_t total = 0;
  for (std::size_t i = 0; i < points.size(); i += 7) {
    const double radius = radii[i % radii.size()];
    index.find(points[i], radius, 0, points.size(), found);
    ASSERT_EQ(found, search(points, points[i], radius)) << "around point " << i;
    total += found.size();
  }
  EXPECT_GT(total, 0u);
}

std::vector<Vector3> scatter(std::size_t count, const Vector3& extents, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Vector3> points(count);
  for (Vector3& point : points) {
    for (int i = 0; i < 3; ++i) {
      point[i] = (static_cast<double>(random()) / 4294967296.0 - 0.5) * extents[i];
    }
  }
  return points;
}

TEST(SpatialIndex, FindsTheSameAsALinearSearch) {
  expect_same_as_search(scatter(700, {4, 4, 4}, 1), {0.5});
  expect_same_as_search(scatter(700, {40, 40, 0}, 2), {1, 3});
  expect_same_as_search(scatter(700, {0, 0, 9}, 3), {0.1});
}

TEST(SpatialIndex, IsCorrectForUnevenRangesAndPositions) {
  auto points = scatter(500, {2, 2, 0.1}, 4);
  points[10] = {1e6, -1e6, 1e6};
  points[20] = points[21] = points[22] = {0.3, 0.3, 0};
  expect_same_as_search(points, {0.01, 0.5, 3e6});
}

TEST(SpatialIndex, FindsPointsInABoxIncludingItsSurface) {
  const auto points = scatter(700, {4, 4, 1}, 5);
  std::vector<std::size_t> found;
  for (const double cell : {0.01, 0.5, 100.0}) {
    SpatialIndex index;
    index.build(points, cell);
    for (std::size_t i = 0; i + 1 < points.size(); i += 7) {
      const Vector3 low = points[i].cwiseMin(points[i + 1]),
                    high = points[i].cwiseMax(points[i + 1]);
      std::vector<std::size_t> expected;
      for (std::size_t k = 100; k < 600; ++k) {
        const auto at = points[k].array();
        if ((at >= low.array()).all() && (at <= high.array()).all()) expected.push_back(k);
      }
      index.find(low, high, 100, 600, found);
      ASSERT_EQ(found, expected) << "cells of " << cell << ", box " << i;
    }
  }
}

TEST(SpatialIndex, NeverFindsPointsThatAreNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Vector3> points{{nan, 0, 0}, {0, 0, 0}, {0, INFINITY, 0}};
  SpatialIndex index;
  index.build(points, {});
  std::vector<std::size_t> found;
  index.find({0, 0, 0}, 1e9, 0, 3, found);
  EXPECT_EQ(found, std::vector<std::size_t>{1});
  index.find({nan, 0, 0}, 1e9, 0, 3, found);
  EXPECT_TRUE(found.empty());
  index.build({}, {});
  index.find({0, 0, 0}, 1, 0, 0, found);
  EXPECT_TRUE(found.empty());
}

TEST(SpatialIndex, FindsOnlyTheRequestedRange) {
  const std::vector<Vector3> points(6, Vector3(1, 1, 1));
  SpatialIndex index;
  index.build(points, {});
  std::vector<std::size_t> found;
  index.find({1, 1, 1.5}, 1, 2, 4, found);
  EXPECT_EQ(found, (std::vector<std::size_t>{2, 3}));
}

TEST(SpatialIndex, HasCellsOfAboutTheSpacing) {
  // Two distant points, or one long range, do not enlarge the cells.
  auto points = scatter(10'000, {100, 100, 0}, 5);
  points[0] = {0, 0, -1e5};
  std::vector<double> radii(points.size(), 1.0);
  radii[1] = 1e6;
  SpatialIndex index;
  index.build(points, radii);
  EXPECT_LT(index.cell(), 3);
}

}  // namespace
}  // namespace ziggurat::media
