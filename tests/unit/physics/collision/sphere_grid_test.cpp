// SPDX-License-Identifier: MIT
// Spheres near a place: all that touch are found, and few others are looked at.

#include "physics/collision/sphere_grid.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <set>
#include <vector>

namespace ziggurat::physics {
namespace {

struct Ball {
  btVector3 centre;
  btScalar radius;
};

std::vector<Ball> balls(int count, double width, double smallest, double largest) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> place(-width, width), size(smallest, largest);
  std::vector<Ball> made;
  for (int i = 0; i < count; ++i) {
    made.push_back({btVector3(place(random), place(random), place(random)), size(random)});
  }
  return made;
}

TEST(SphereGrid, FindsAllThatTouchWhateverTheirSizes) {
  auto all = balls(1000, 5, 0.01, 0.1);
  for (const Ball& large : balls(20, 5, 1, 8)) all.push_back(large);
  SphereGrid nearby;
  for (std::size_t i = 0; i < all.size(); ++i) nearby.add(i, all[i].centre, all[i].radius);
  for (const Ball& ball : all) {
    std::set<std::size_t> visited;
    nearby.visit(ball.centre, ball.radius,
                 [&](std::size_t i) { EXPECT_TRUE(visited.insert(i).second) << "once"; });
    for (std::size_t i = 0; i < all.size(); ++i) {
      const bool touches = (all[i].centre - ball.centre).length() <= all[i].radius + ball.radius;
      EXPECT_TRUE(!touches || visited.contains(i)) << i;
    }
  }
}

TEST(SphereGrid, LooksAtFewOfMany) {
  const auto all = balls(20'000, 100, 0.1, 0.2);
  SphereGrid nearby;
  for (std::size_t i = 0; i < all.size(); ++i) nearby.add(i, all[i].centre, all[i].radius);
  std::size_t visits = 0;
  for (const Ball& ball : all)
    nearby.visit(ball.centre, ball.radius, [&](std::size_t) { ++visits; });
  EXPECT_LT(visits, 2 * all.size());
}

TEST(SphereGrid, WhatHasNoSizeIsEverywhere) {
  SphereGrid nearby;
  nearby.add(3, {0, 0, 0}, 0);
  nearby.add(4, {0, 0, 0}, std::numeric_limits<btScalar>::infinity());
  std::set<std::size_t> visited;
  nearby.visit({1000, 0, 0}, 0.1, [&](std::size_t i) { visited.insert(i); });
  EXPECT_EQ(visited, (std::set<std::size_t>{3, 4}));
}

}  // namespace
}  // namespace ziggurat::physics
