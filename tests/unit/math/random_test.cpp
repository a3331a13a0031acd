// SPDX-License-Identifier: MIT
#include "math/random.h"

#include <gtest/gtest.h>

namespace ziggurat::math {
namespace {

TEST(RandomStream, SameSeedAndPurposeGiveTheSameNumbers) {
  RandomStream one(7, "distribute"), two(7, "distribute");
  for (int i = 0; i < 100; ++i) EXPECT_EQ(one.uniform(-1, 1), two.uniform(-1, 1));
}

TEST(RandomStream, PurposeAndSeedSeparateStreams) {
  const double first = RandomStream(7, "distribute").uniform(0, 1);
  EXPECT_NE(first, RandomStream(7, "proximity").uniform(0, 1));
  EXPECT_NE(first, RandomStream(8, "distribute").uniform(0, 1));
}

TEST(RandomStream, UniformStaysWithinItsBoundsAndHasTheRightMean) {
  RandomStream stream(1, "test");
  double sum = 0;
  for (int i = 0; i < 100000; ++i) {
    const double value = stream.uniform(2, 6);
    ASSERT_GE(value, 2);
    ASSERT_LE(value, 6);
    sum += value;
  }
  EXPECT_NEAR(sum / 100000, 4, 0.02);  // standard error 0.0037
}

TEST(RandomStream, EqualBoundsDrawNothing) {
  RandomStream one(3, "test"), two(3, "test");
  EXPECT_EQ(one.uniform(5, 5), 5);
  EXPECT_EQ(one.uniform(0, 1), two.uniform(0, 1));
}

TEST(RandomStream, GaussianHasItsMeanAndDeviation) {
  RandomStream stream(1, "test");
  double sum = 0, squares = 0;
  for (int i = 0; i < 100000; ++i) {
    const double value = stream.gaussian(3, 0.5);
    sum += value;
    squares += (value - 3) * (value - 3);
  }
  EXPECT_NEAR(sum / 100000, 3, 0.01);
  EXPECT_NEAR(squares / 100000, 0.25, 0.01);
}

}  // namespace
}  // namespace ziggurat::math
