// SPDX-License-Identifier: MIT
#include "recording/replay/difference.h"

#include <gtest/gtest.h>

#include <numbers>
#include <string>
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

/// Two robots: each has two joints and one radio, the second one wheels, too.
struct Example {
  world::Layout layout;
  world::Commands recorded, now;

  Example() {
    layout.robots.resize(2);
    layout.joint_actuators = {{"left"}, {"right"}, {"arm"}, {"hand"}};
    layout.radios.resize(2);
    layout.radios[1].id = "rx";
    layout.wheels.resize(1);
    layout.wheels[0].drives = true;
    layout.robots[0].joint_actuators = {0, 2};
    layout.robots[1].joint_actuators = {2, 2};
    layout.robots[0].radios = {0, 1};
    layout.robots[1].radios = {1, 1};
    layout.robots[1].wheels = {0, 1};
    recorded.joint_targets = {1, 2, 3, 4};
    recorded.wheels = {{0.5, 0.5}};
    now = recorded;
  }
  static void send(world::Commands& commands, std::size_t radio, const std::string& text) {
    commands.radio_messages.add(radio,
                                {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  std::optional<CommandDifference> of(std::size_t robot) const {
    return first_difference(layout, robot, recorded, now);
  }
};

TEST(CommandDifference, IsOfTheRobotAndNamesItsDevice) {
  Example example;
  EXPECT_FALSE(example.of(0));
  EXPECT_FALSE(example.of(1));
  example.now.joint_targets[3] = 4.5;
  EXPECT_FALSE(example.of(0));
  const auto found = example.of(1);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->device, "joint_targets of 'hand'");
  EXPECT_EQ(found->recorded, "4");
  EXPECT_EQ(found->now, "4.5");
}

TEST(CommandDifference, IsOfBits) {
  Example example;
  example.recorded.joint_targets[0] = 0.0;
  example.now.joint_targets[0] = -0.0;
  EXPECT_TRUE(example.of(0));
}

TEST(CommandDifference, HasBothWheels) {
  Example example;
  example.now.wheels[0].right = 0.25;
  const auto found = example.of(1);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->device, "wheels");
  EXPECT_EQ(found->now, "0.5 (left), 0.25 (right)");
}

TEST(CommandDifference, ComparesRadioMessagesOfEachRadioInTheirOrder) {
  Example example;
  Example::send(example.recorded, 0, "a");
  Example::send(example.recorded, 1, "b");
  Example::send(example.now, 1, "b");  // radios may be in any order
  Example::send(example.now, 0, "a");
  EXPECT_FALSE(example.of(0));
  EXPECT_FALSE(example.of(1));
  Example::send(example.now, 1, "c\n");
  const auto found = example.of(1);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->device, "radio message 1 of 'rx'");
  EXPECT_EQ(found->recorded, "nothing");
  EXPECT_EQ(found->now, "2 bytes 'c\\x0a'");
}

}  // namespace
}  // namespace ziggurat::replay
