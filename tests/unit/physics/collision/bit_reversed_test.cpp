// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <vector>

#include "physics/collision/sphere_grid.h"

namespace ziggurat::physics {
namespace {

std::vector<std::size_t> order(std::size_t count) {
  std::vector<std::size_t> out;
  in_bit_reversed_order(count, [&](std::size_t i) { out.push_back(i); });
  return out;
}

TEST(BitReversedOrder, HalvesTheRowAgainAndAgain) {
  EXPECT_EQ(order(0), std::vector<std::size_t>());
  EXPECT_EQ(order(1), std::vector<std::size_t>({0}));
  EXPECT_EQ(order(8), std::vector<std::size_t>({0, 4, 2, 6, 1, 5, 3, 7}));
  EXPECT_EQ(order(6), std::vector<std::size_t>({0, 4, 2, 1, 5, 3}));
}

}  // namespace
}  // namespace ziggurat::physics
