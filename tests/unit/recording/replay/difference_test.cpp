#include "recording/replay/difference.h"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

namespace ziggurat::replay {
namespace {

TEST(Difference, IsOfBits) {
  std::vector<world::LinkState> a(3), b(3);
  EXPECT_FALSE(first_difference(a, b));
  b[2].angular_velocity.y() = -0.0;
  const auto found = first_difference(a, b);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->link, 2u);
  EXPECT_EQ(found->field, "angular_velocity.y");
  b[1].pose.orientation.w() = 0.5;
  EXPECT_EQ(first_difference(a, b)->field, "orientation.w");
  EXPECT_EQ(first_difference(a, b)->a, 1);
  EXPECT_EQ(first_difference(a, b)->b, 0.5);
}

TEST(Difference, ComparesLinksThatBothHave) {
  std::vector<world::LinkState> a(3), b(2);
  EXPECT_FALSE(first_difference(a, b));
}

TEST(Distance, HasTheFarthestLinkAndTheMean) {
  std::vector<world::LinkState> a(4), b(4);
  b[1].pose.position = {0, 3, 4};
  b[2].pose.position = {1, 0, 0};
  b[3].pose.orientation = math::Quaternion(0, 0, 1, 0);
  const Distance apart = distance(a, b);
  EXPECT_DOUBLE_EQ(apart.greatest, 5);
  EXPECT_DOUBLE_EQ(apart.mean, 1.5);
  EXPECT_DOUBLE_EQ(apart.angle, std::numbers::pi);
  EXPECT_EQ(apart.link, 1u);
}

}  // namespace
}  // namespace ziggurat::replay
