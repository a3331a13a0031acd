// SPDX-License-Identifier: MIT
// Painted regions of a floor: what they cover, and which of them are forgotten.

#include "world/floor.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ziggurat::world {
namespace {

FloorPaint rectangle(double x, double y, double width, double height, Color color) {
  return {{x, y}, {width / 2, height / 2}, false, color};
}
FloorPaint disc(double x, double y, double radius, Color color) {
  return {{x, y}, {radius, radius}, true, color};
}

TEST(Floor, HasTheColourThatWasPaintedLast) {
  std::vector<FloorPaint> floor;
  EXPECT_FALSE(painted_color(floor, 0, 0));
  ASSERT_TRUE(paint(floor, rectangle(1, 2, 4, 2, 0xFF0000)));
  ASSERT_TRUE(paint(floor, disc(2, 2, 1, 0x0000FF)));
  EXPECT_EQ(painted_color(floor, -0.99, 1.01), 0xFF0000U);
  EXPECT_EQ(painted_color(floor, 2, 2.9), 0x0000FFU);
  EXPECT_EQ(painted_color(floor, 2 + std::sqrt(0.5) + 1e-9, 2 + std::sqrt(0.5)), 0xFF0000U)
      << "outside of the disc";
  EXPECT_FALSE(painted_color(floor, -1.01, 2));
  EXPECT_FALSE(painted_color(floor, 1, 3.01));
}

TEST(Floor, ForgetsWhatIsHidden) {
  std::vector<FloorPaint> floor;
  paint(floor, disc(0, 0, 1, 1));
  paint(floor, rectangle(0, 0, 1.99, 2, 2));
  EXPECT_EQ(floor.size(), 2u) << "the disc looks out on both sides";
  paint(floor, rectangle(0, 0, 2, 2, 3));
  EXPECT_EQ(floor.size(), 1u);
  paint(floor, disc(0, 0, 1.4, 4));
  EXPECT_EQ(floor.size(), 2u) << "the corners look out";
  paint(floor, disc(0, 0, 1.42, 5));
  EXPECT_EQ(floor.size(), 1u);
}

TEST(Floor, RemembersSoManyRegions) {
  std::vector<FloorPaint> floor;
  for (std::size_t i = 0; i < most_floor_paints; ++i)
    ASSERT_TRUE(paint(floor, disc(static_cast<double>(i), 0, 0.1, 1)));
  EXPECT_FALSE(paint(floor, disc(-1, 0, 0.1, 1)));
  EXPECT_EQ(floor.size(), most_floor_paints);
  EXPECT_TRUE(paint(floor, rectangle(0, 0, 1e6, 1, 2))) << "it hides all";
  EXPECT_EQ(floor.size(), 1u);
}

TEST(Floor, ChecksRegions) {
  EXPECT_TRUE(is_valid(rectangle(1, 2, 3, 4, 0xFFFFFF)));
  EXPECT_FALSE(is_valid(rectangle(1, 2, 0, 4, 0)));
  EXPECT_FALSE(is_valid(rectangle(NAN, 2, 3, 4, 0)));
  EXPECT_FALSE(is_valid(rectangle(1, 2e6, 3, 4, 0)));
  EXPECT_FALSE(is_valid(rectangle(1, 2, 3, 4, 0x1000000)));
  EXPECT_FALSE(is_valid({{0, 0}, {1, 2}, true, 0})) << "an ellipse";
}

}  // namespace
}  // namespace ziggurat::world
