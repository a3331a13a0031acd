#include "recording/replay/commands_difference.h"

#include <gtest/gtest.h>

#include <string>

namespace ziggurat::replay {
namespace {

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
