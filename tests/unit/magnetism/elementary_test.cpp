// SPDX-License-Identifier: MIT
#include "magnetism/elementary.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ziggurat::magnetism {
namespace {

TEST(Elementary, MatchesTheStandardLibrary) {
  for (double x = 1e-200; x < 1e200; x *= 1.37) {
    EXPECT_NEAR(logarithm(x), std::log(x), 2e-15 * std::fabs(std::log(x)) + 1e-16);
  }
  for (double x = 0; x < 690; x += 0.37) EXPECT_NEAR(decay(x), std::exp(-x), 2e-15 * std::exp(-x));
  EXPECT_EQ(decay(1e9), 0);
  for (int k = 0; k < 1000; ++k) {
    const double turn = -3.14159 + 6.28318 * k / 999;
    const double x = std::cos(turn);
    const double y = std::sin(turn);
    EXPECT_NEAR(angle(y, x), std::atan2(y, x), 1e-15 * 4);
  }
  EXPECT_EQ(angle(0, 0), 0);
  EXPECT_NEAR(angle(0, -1), 3.14159265358979323846, 1e-15);
}

}  // namespace
}  // namespace ziggurat::magnetism
