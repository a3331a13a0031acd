// What is written of states and commands: what has changed.

#include <gtest/gtest.h>

#include <cmath>

#include "recorder/exact_state.h"
#include "recorder/inputs.h"

namespace ziggurat::recorder {
namespace {

world::State two_links() {
  world::State state;
  state.links.resize(2);
  state.links[1].pose.position = {1, 2, 3};
  return state;
}

TEST(StateChanges, HasTheLinksThatMoved) {
  StateChanges changes;
  world::State state = two_links();
  v1::ExactState message;
  changes.fill(state, message);
  EXPECT_TRUE(message.is_complete());
  EXPECT_EQ(message.links_size(), 0);
  ASSERT_EQ(message.values_size(), 26);
  EXPECT_EQ(message.values(15), 3);
  EXPECT_EQ(message.values(16), 1) << "w";

  state.tick = 1;
  state.links[1].angular_velocity.z() = -0.0;  // other bits, the same number
  changes.fill(state, message);
  EXPECT_FALSE(message.is_complete());
  EXPECT_EQ(message.tick(), 1u);
  ASSERT_EQ(message.links_size(), 1);
  EXPECT_EQ(message.links(0), 1u);
  EXPECT_TRUE(std::signbit(message.values(12)));

  changes.fill(state, message);
  EXPECT_EQ(message.links_size() + message.values_size(), 0);
  changes.forget();
  changes.fill(state, message);
  EXPECT_TRUE(message.is_complete());
}

TEST(StateChanges, ALinkThatCameMakesItComplete) {
  StateChanges changes;
  world::State state = two_links();
  v1::ExactState message;
  changes.fill(state, message);
  state.links.emplace_back();
  changes.fill(state, message);
  EXPECT_TRUE(message.is_complete());
  EXPECT_EQ(message.values_size(), 39);
}

TEST(CommandChanges, LeavesOutWhatIsAsBefore) {
  CommandChanges changes;
  world::Commands commands;
  commands.joint_targets = {0.5, 1};
  commands.wheels = {{1, 2}};
  commands.tag_payloads = {"a", std::string("\0b", 2)};
  commands.turret_modes = {world::TurretMode::speed};
  commands.radio_messages.add(3, std::vector<std::uint8_t>{7, 8});
  v1::Commands first;
  changes.fill(commands, first);
  EXPECT_EQ(first.joint_targets().values(1), 1);
  EXPECT_EQ(first.wheels().values_size(), 2);
  EXPECT_EQ(first.tag_payloads().values(1), std::string("\0b", 2));
  EXPECT_EQ(first.turret_modes().values(0), 2u);
  EXPECT_EQ(first.radio_messages(0).payload(), "\x07\x08");

  commands.joint_targets[0] = -0.5;
  v1::Commands second;
  changes.fill(commands, second);
  EXPECT_EQ(second.joint_targets().values_size(), 2) << "arrays are whole";
  EXPECT_FALSE(second.has_wheels());
  EXPECT_FALSE(second.has_tag_payloads());
  EXPECT_EQ(second.radio_messages_size(), 1) << "they are of each tick";

  changes.forget();
  v1::Commands third;
  changes.fill(commands, third);
  EXPECT_TRUE(third.has_wheels());
}

}  // namespace
}  // namespace ziggurat::recorder
