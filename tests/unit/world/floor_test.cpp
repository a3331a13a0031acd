// SPDX-License-Identifier: MIT
// Painted regions of a floor: what they cover, and which of them are forgotten.

#include "world/floor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <variant>

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

/// A PPM file of one row, with a red pixel and a green one.
std::string red_and_green() { return "P6 2 1 255\n" + std::string("\xff\0\0\0\xff\0", 6); }
FloorPaint with_image(double width, double height) {
  FloorPaint region = rectangle(0, 0, width, height, 0);
  region.image = std::get<0>(floor_image(red_and_green()));
  return region;
}

TEST(Floor, HasTheColoursOfAnImage) {
  std::vector<FloorPaint> floor;
  paint(floor, disc(0, 0, 0.5, 1));
  paint(floor, disc(2, 0, 0.5, 1));
  EXPECT_EQ(image_on(floor), nullptr);
  ASSERT_TRUE(paint(floor, with_image(4, 2)));
  EXPECT_EQ(floor.size(), 1u) << "it hides all, also beside it";
  ASSERT_TRUE(paint(floor, disc(1, 0, 0.25, 0x0000FF)));
  EXPECT_EQ(image_on(floor), floor[0].image.get());
  EXPECT_EQ(painted_color(floor, -0.01, 0.9), 0xFF0000U);
  EXPECT_EQ(painted_color(floor, 0.01, -0.9), 0x00FF00U);
  EXPECT_EQ(painted_color(floor, 1, 0), 0x0000FFU);
  EXPECT_FALSE(painted_color(floor, -2.01, 0));
}

TEST(Floor, ReadsImagesOrSaysWhyNot) {
  for (const char* file : {"", "GIF89a", "P6 2 1 255\n", "\x89PNG", "P6 99999 99999 255\n"})
    EXPECT_NE(std::get<std::string>(floor_image(file)), "") << file;
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
  EXPECT_TRUE(is_valid(with_image(1, 1)));
  FloorPaint coloured = with_image(1, 1);
  coloured.color = 1;
  EXPECT_FALSE(is_valid(coloured));
  EXPECT_FALSE(is_valid(rectangle(1, 2, 0, 4, 0)));
  EXPECT_FALSE(is_valid(rectangle(NAN, 2, 3, 4, 0)));
  EXPECT_FALSE(is_valid(rectangle(1, 2e6, 3, 4, 0)));
  EXPECT_FALSE(is_valid(rectangle(1, 2, 3, 4, 0x1000000)));
  EXPECT_FALSE(is_valid({{0, 0}, {1, 2}, true, 0})) << "an ellipse";
}

}  // namespace
}  // namespace ziggurat::world
