// SPDX-License-Identifier: MIT
// Packing of commands and states, there and back, and messages that no writer makes.

#include "recording/inputs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "ziggurat/v1/run.pb.h"

namespace ziggurat::recording {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A robot with one device of each kind that has commands, and two radios of which one sends.
struct Example {
  world::Layout layout;
  world::State state;
  world::Commands commands;

  Example() {
    layout.entities = {{"r0", {0, 1}, true}};
    layout.robots.resize(1);
    layout.robots[0].id = "r0";
    layout.robots[0].radios = {0, 2};
    layout.radios.resize(2);
    layout.radios[0].id = "rx";
    layout.radios[0].sends = true;
    commands.joint_targets = {1.5, -0.0};
    commands.led_colors = {0xFFFFFF};
    commands.directional_led_colors = {0x0000FF};
    commands.tag_payloads = {std::string("a\0b", 3)};
    commands.magnet_currents = {-2};
    commands.range_and_bearing_data = {0, 255, 7};
    commands.wheels = {{0.1, -0.2}};
    commands.turret_modes = {world::TurretMode::speed};
    commands.turret_rotations = {3};
    commands.turret_speeds = {-4};
  }

  void send(std::size_t radio, const std::string& text) {
    commands.radio_messages.add(radio,
                                {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  std::optional<std::string> read(const v1::Commands& message, world::Commands& to) const {
    return unpack(message, layout, state, commands, to);
  }
  std::string fault_of(const v1::Commands& message) const {
    world::Commands read = commands;
    return unpack(message, layout, state, commands, read).value_or("");
  }
};

/// All values, as text with all digits.
std::string text_of(const world::Commands& commands) {
  CommandPacker packer;
  v1::Commands message;
  packer.pack(commands, message);
  return message.SerializeAsString();
}

TEST(Inputs, GiveBackAllCommands) {
  Example example;
  example.send(0, "hello");
  example.send(0, "");
  CommandPacker packer;
  v1::Commands message;
  packer.pack(example.commands, message);
  world::Commands read;
  EXPECT_EQ(example.read(message, read), std::nullopt);
  EXPECT_EQ(text_of(read), text_of(example.commands));
  EXPECT_EQ(read.joint_targets, example.commands.joint_targets);
  EXPECT_TRUE(std::signbit(read.joint_targets[1]));
  EXPECT_EQ(read.radio_messages.entries.size(), 2u);
}

TEST(Inputs, LeaveOutArraysThatDidNotChange) {
  Example example;
  CommandPacker packer;
  v1::Commands first, second, third;
  packer.pack(example.commands, first);
  packer.pack(example.commands, second);
  EXPECT_EQ(second.ByteSizeLong(), 0u);
  example.commands.joint_targets[1] = 0.0;  // other bits than -0.0
  packer.pack(example.commands, third);
  EXPECT_TRUE(third.has_joint_targets());
  EXPECT_FALSE(third.has_wheels());

  world::Commands read;
  EXPECT_EQ(example.read(first, read), std::nullopt);
  EXPECT_EQ(example.read(second, read), std::nullopt);
  EXPECT_EQ(example.read(third, read), std::nullopt);
  EXPECT_EQ(text_of(read), text_of(example.commands));
  EXPECT_FALSE(std::signbit(read.joint_targets[1]));
}

TEST(Inputs, RadioMessagesAreThoseOfTheirTickOnly) {
  Example example;
  CommandPacker packer;
  v1::Commands first, second;
  example.send(0, "hello");
  packer.pack(example.commands, first);
  example.commands.radio_messages.clear();
  packer.pack(example.commands, second);
  world::Commands read;
  EXPECT_EQ(example.read(first, read), std::nullopt);
  EXPECT_EQ(example.read(second, read), std::nullopt);
  EXPECT_TRUE(read.radio_messages.entries.empty());
}

TEST(Inputs, AreRefusedWithAnotherNumberOfValues) {
  const Example example;
  v1::Commands message;
  message.mutable_joint_targets()->add_values(1);
  EXPECT_EQ(example.fault_of(message),
            "the array joint_targets has 1 values; the world has 2 joint actuators");
  message.Clear();
  message.mutable_wheels()->add_values(1);
  EXPECT_EQ(example.fault_of(message),
            "the array wheels has a value that is out of range or half a value");
  world::Commands none;
  EXPECT_EQ(example.read({}, none),
            "the array joint_targets has 0 values; the world has 2 joint actuators");
}

TEST(Inputs, AreRefusedWithValuesThatNoRobotMaySet) {
  const Example example;
  v1::Commands message;
  message.mutable_joint_targets()->add_values(1);
  message.mutable_joint_targets()->add_values(infinity);
  EXPECT_EQ(example.fault_of(message), "the target of joint number 1 must be finite");
  message.Clear();
  message.mutable_led_colors()->add_values(0x1000000);
  EXPECT_EQ(example.fault_of(message), "the color of LED number 0 must be 0xRRGGBB");
  message.Clear();
  message.mutable_turret_modes()->add_values(3);
  EXPECT_NE(example.fault_of(message), "");
  message.mutable_turret_modes()->set_values(0, 256);  // 0 in a byte
  EXPECT_NE(example.fault_of(message), "");
  message.Clear();
  message.mutable_tag_payloads()->add_values(std::string(65537, 'x'));
  EXPECT_EQ(example.fault_of(message), "the payload of tag number 0 must be at most 65536 bytes");
}

TEST(Inputs, AreRefusedWithRadioMessagesThatNoRobotMaySend) {
  Example example;
  v1::Commands message;
  auto& radio = *message.add_radio_messages();
  radio.set_radio(2);
  EXPECT_EQ(example.fault_of(message), "there is no radio number 2");
  radio.set_radio(1);
  EXPECT_EQ(example.fault_of(message), "the radio '', number 1, can't send");
  radio.set_radio(0);
  EXPECT_EQ(example.fault_of(message), "");
  example.state.absent = {true};
  EXPECT_EQ(example.fault_of(message), "the radio 'rx', number 0, can't send");
  example.state.absent = {};
  radio.set_payload(std::string(world::most_radio_message_bytes + 1, 'x'));
  EXPECT_NE(example.fault_of(message), "");
  radio.set_payload(std::string(world::most_radio_message_bytes, 'x'));
  for (int i = 0; i < 16; ++i) *message.add_radio_messages() = radio;
  EXPECT_NE(example.fault_of(message), "");
}

world::LinkState link(double seed) {
  world::LinkState link;
  link.pose.position = {seed, seed / 3, -0.0};
  link.pose.orientation = math::Quaternion(0.5, 0.5, -0.5, seed);
  link.velocity = {1, seed, 2};
  link.angular_velocity = {3, 4, seed};
  return link;
}

std::string bits_of(const std::vector<world::LinkState>& links) {
  world::State state;
  state.links = links;
  v1::ExactState message;
  StatePacker().pack(0, state, message);
  return message.SerializeAsString();
}

TEST(Inputs, GiveBackWhatWasPaintedOnTheFloorAtThatTick) {
  Example example;
  example.commands.floor_paints = {{{1, 2}, {3, 4}, false, 0x123456}, {{-1, 0}, {2, 2}, true, 7}};
  CommandPacker packer;
  v1::Commands first, second;
  packer.pack(example.commands, first);
  world::Commands read = example.commands;
  read.floor_paints.clear();
  ASSERT_EQ(example.read(first, read), std::nullopt);
  EXPECT_EQ(read.floor_paints, example.commands.floor_paints);
  example.commands.floor_paints.clear();
  packer.pack(example.commands, second);
  ASSERT_EQ(example.read(second, read), std::nullopt);
  EXPECT_TRUE(read.floor_paints.empty());
  first.mutable_floor_paints(0)->mutable_values()->RemoveLast();
  EXPECT_NE(example.fault_of(first).find("painted region"), std::string::npos);
}

TEST(Inputs, GiveBackAnImageThatWasLaidOnTheFloor) {
  Example example;
  world::FloorPaint laid{{0, 0}, {2, 2}};
  laid.image = std::get<0>(world::floor_image("P5 1 1 255\nx"));
  example.commands.floor_paints = {laid};
  v1::Commands packed;
  CommandPacker().pack(example.commands, packed);
  world::Commands read = example.commands;
  ASSERT_EQ(example.read(packed, read), std::nullopt);
  ASSERT_EQ(read.floor_paints.size(), 1u);
  EXPECT_EQ(read.floor_paints[0].image->file, laid.image->file);
  packed.mutable_floor_paints(0)->set_image("P5 1 1 255\n");
  EXPECT_NE(example.fault_of(packed).find("ends before its last pixel"), std::string::npos);
}

TEST(ExactState, GivesBackLinksFromChanges) {
  StatePacker packer;
  world::State state;
  state.links = {link(0.1), link(0.2), link(0.3)};
  std::vector<world::LinkState> read;
  v1::ExactState first;
  packer.pack(0, state, first);
  EXPECT_TRUE(first.is_complete());
  EXPECT_EQ(unpack(first, read), std::nullopt);
  EXPECT_EQ(bits_of(read), bits_of(state.links));

  state.links[1].angular_velocity.z() = -0.0;
  v1::ExactState second;
  packer.pack(0, state, second);
  EXPECT_EQ(second.links_size(), 1);
  EXPECT_EQ(second.links(0), 1u);
  EXPECT_EQ(unpack(second, read), std::nullopt);
  EXPECT_EQ(bits_of(read), bits_of(state.links));

  state.links.push_back(link(0.4));
  v1::ExactState third;
  packer.pack(0, state, third);
  EXPECT_TRUE(third.is_complete());
  EXPECT_EQ(unpack(third, read), std::nullopt);
  EXPECT_EQ(bits_of(read), bits_of(state.links));
}

TEST(ExactState, IsRefusedWithLinksThatAreNotThere) {
  std::vector<world::LinkState> links{link(1)};
  const std::string before = bits_of(links);
  v1::ExactState message;
  message.set_tick(5);
  message.add_links(1);
  for (int i = 0; i < 13; ++i) message.add_values(i);
  EXPECT_EQ(unpack(message, links),
            "the state of tick 5 has a link number 1; the state before has 1");
  message.add_links(0);
  EXPECT_EQ(unpack(message, links),
            "the state of tick 5 has 13 values for 2 links; there must be 13 each");
  message.clear_links();
  message.set_is_complete(true);
  message.add_values(0);
  EXPECT_NE(unpack(message, links), std::nullopt);
  EXPECT_EQ(bits_of(links), before);
}

}  // namespace
}  // namespace ziggurat::recording
