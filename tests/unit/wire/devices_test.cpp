// SPDX-License-Identifier: MIT
// Devices on the wire: what goes where, and what is refused.

#include "wire/devices.h"

#include <gtest/gtest.h>

#include <string>

#include "wire/command.h"
#include "wire/device_wire.h"
#include "world/limits.h"

namespace ziggurat::wire {
namespace {

// ---- commands -----------------------------------------------------------------------------------

TEST_F(DeviceWire, ValuesOfAllRobots) {
  for (const std::uint32_t color : {0xFF0000, 0x00FF00, 0x0000FF}) {
    command->add_led_colors(color);
    command->add_directional_led_colors(color + 1);
  }
  for (const char* payload : {"x", "", "z"}) command->add_tag_payloads(payload);
  for (const double current : {1.0, -2.0, 0.5}) command->add_magnet_currents(current);
  command->set_range_and_bearing_data("AAAACCC\xff");
  apply();
  EXPECT_EQ(commands.led_colors,
            (std::vector<world::Color>{0xFF0000, 0x010203, 0x00FF00, 0x0000FF}));
  EXPECT_EQ(commands.directional_led_colors,
            (std::vector<world::Color>{0xFF0001, 0x00FF01, 0x000100}));
  EXPECT_EQ(commands.tag_payloads, (std::vector<std::string>{"x", "payload1", "", "z"}));
  EXPECT_EQ(commands.magnet_currents, (std::vector<double>{1, 0, -2, 0.5}));
  EXPECT_EQ(text_of(commands.range_and_bearing_data), std::string("AAAA\0\0\0\0CCC\xff", 12));
}

TEST_F(DeviceWire, WhatIsCommandedIsWrittenAsItIsRead) {
  double number = 0.5;
  for (auto& target : commands.joint_targets) target = number += 1;
  for (auto& current : commands.magnet_currents) current = number += 1;
  for (auto& color : commands.led_colors) color = static_cast<world::Color>(number += 1);
  for (auto& payload : commands.tag_payloads) payload = std::to_string(number += 1);
  for (auto& byte : commands.range_and_bearing_data) byte = static_cast<std::uint8_t>(number += 1);
  add_channels(roster, commands, *command);
  EXPECT_EQ(command->led_colors_size(), 3) << "those that robots set";
  const std::string written = command->SerializeAsString();
  commands = run.commands();
  apply();
  command->Clear();
  add_channels(roster, commands, *command);
  EXPECT_EQ(command->SerializeAsString(), written);
}

TEST_F(DeviceWire, ValuesOfSomeRobotsInTheOrderGiven) {
  command->add_robots(2);
  command->add_robots(1);
  command->add_robots(0);
  for (const std::uint32_t color : {1, 2, 3}) command->add_led_colors(color);
  command->set_range_and_bearing_data("CCCCAAAA");
  apply();
  EXPECT_EQ(commands.led_colors, (std::vector<world::Color>{3, 0x010203, 1, 2}));
  EXPECT_EQ(text_of(commands.range_and_bearing_data), std::string("AAAA\0\0\0\0CCCC", 12));
}

TEST_F(DeviceWire, NothingGivenChangesNothing) {
  apply();
  const world::Commands before = run.commands();
  EXPECT_EQ(commands.led_colors, before.led_colors);
  EXPECT_EQ(commands.tag_payloads, before.tag_payloads);
  EXPECT_TRUE(commands.radio_messages.entries.empty());
}

TEST_F(DeviceWireOfC, StandsAtTheBeginningOfItsSession) {
  command->add_led_colors(7);
  command->add_led_colors(8);
  send(0, "hello");
  apply();
  EXPECT_EQ(commands.led_colors, (std::vector<world::Color>{0, 0x010203, 7, 8}));
  EXPECT_EQ(sent(), (Sent{{2, "hello"}}));
}

TEST_F(DeviceWire, RadioMessagesKeepTheirOrderAndTheirBytes) {
  const std::string all_bytes = [] {
    std::string text;
    for (int i = 0; i < 256; ++i) text += static_cast<char>(i);
    return text;
  }();
  send(1, "first");
  send(2, all_bytes);
  send(1, "");
  send(0, "x");
  apply();
  EXPECT_EQ(sent(), (Sent{{1, "first"}, {2, all_bytes}, {1, ""}, {0, "x"}}));
}

TEST_F(DeviceWire, RobotsThatLeftSendAndSetNothing) {
  roster.leave(0);
  for (const std::uint32_t color : {1, 2, 3}) command->add_led_colors(color);
  send(0, "last words");
  send(2, "hello");
  apply();
  EXPECT_EQ(commands.led_colors, (std::vector<world::Color>{0, 0x010203, 2, 3}));
  EXPECT_EQ(sent(), (Sent{{2, "hello"}}));
}

TEST_F(DeviceWire, RobotsThatLeftKeepTheirColorsAndAreOtherwiseZero) {
  commands.magnet_currents = {1, 2, 3, 4};
  commands.led_colors = {1, 2, 3, 4};
  commands.range_and_bearing_data.assign(12, 9);
  reset_commands(run.layout(), 2, commands);
  EXPECT_EQ(commands.magnet_currents, (std::vector<double>{1, 2, 0, 0}));
  EXPECT_EQ(commands.led_colors, (std::vector<world::Color>{1, 2, 3, 4}));
  EXPECT_EQ(commands.range_and_bearing_data,
            (std::vector<std::uint8_t>{9, 9, 9, 9, 9, 9, 9, 9, 0, 0, 0, 0}));
}

// ---- hostile commands ---------------------------------------------------------------------------

TEST_F(DeviceWire, WrongLengths) {
  for (int i = 0; i < 4; ++i) command->add_led_colors(1);
  expect_fault(ErrorCode::bad_value, "led_colors", "", "is 4; it must be 3 (3 LEDs");
  command->add_directional_led_colors(1);
  expect_fault(ErrorCode::bad_value, "directional_led_colors", "", "(3 directional LEDs");
  command->add_tag_payloads("x");
  expect_fault(ErrorCode::bad_value, "tag_payloads", "", "is 1; it must be 3");
  command->add_magnet_currents(1);
  expect_fault(ErrorCode::bad_value, "magnet_currents", "", "(3 magnets");
  command->set_range_and_bearing_data("123456789");
  expect_fault(ErrorCode::bad_value, "range_and_bearing_data", "", "is 9; it must be 8");
  command->add_robots(1);
  command->add_led_colors(1);
  expect_fault(ErrorCode::bad_value, "led_colors", "", "(0 LEDs");
}

TEST_F(DeviceWire, InvalidValues) {
  command->add_led_colors(0);
  command->add_led_colors(0);
  command->add_led_colors(0x1000000);
  expect_fault(ErrorCode::bad_value, "led_colors", "c", "LED 'led3' of robot 'c' is 0x1000000");
  for (const double current : {0.0, nan, 0.0}) command->add_magnet_currents(current);
  expect_fault(ErrorCode::bad_value, "magnet_currents", "c",
               "magnet 'magnet2' of robot 'c' is nan");
  command->add_robots(2);
  command->add_robots(0);
  for (const std::uint32_t color : {0U, 0U, ~0U}) command->add_directional_led_colors(color);
  expect_fault(ErrorCode::bad_value, "directional_led_colors", "a", "'directional0' of robot 'a'");
  for (const std::size_t size : {0U, 1U, 0U}) {
    command->add_tag_payloads(std::string(world::most_tag_payload_bytes + size, 'x'));
  }
  expect_fault(ErrorCode::too_large, "tag_payloads", "c", "tag 'tag2' of robot 'c' is 65537 bytes");
}

TEST_F(DeviceWire, UnknownRadios) {
  send(4, "x");
  expect_fault(ErrorCode::unknown_device, "radio_messages", "", "have 4 radios");
  send(1'000'000'000, "x");
  expect_fault(ErrorCode::unknown_device, "radio_messages", "", "position 1000000000");
  send(3, "x");
  expect_fault(ErrorCode::unknown_device, "radio_messages", "c",
               "'radio3' of robot 'c' can't send");
  command->add_robots(0);
  send(2, "x");
  expect_fault(ErrorCode::not_yours, "radio_messages", "c", "belongs to robot 'c'");
}

TEST_F(DeviceWireOfC, RadiosOfOtherSessions) {
  send(2, "x");
  expect_fault(ErrorCode::unknown_device, "radio_messages", "", "have 2 radios");
}

TEST_F(DeviceWire, AWholeCommandIsRefusedForOneFault) {
  for (int i = 0; i < 3; ++i) command->add_led_colors(1);
  send(0, "x");
  send(9, "x");
  expect_fault(ErrorCode::unknown_device, "radio_messages", "", "none at");
}

TEST_F(DeviceWire, MessagesHaveTheirLimits) {
  const std::string most(world::most_radio_message_bytes, 'x');
  for (int i = 0; i < 16; ++i) send(i % 2, most);
  send(2, most);
  EXPECT_FALSE(check()) << "each robot has a limit of its own";
  send(1, "");
  EXPECT_FALSE(check());
  send(1, "x");
  expect_fault(ErrorCode::too_large, "radio_messages", "a", "more than 16777216 bytes");
  send(0, most + "x");
  expect_fault(ErrorCode::too_large, "radio_messages", "a", "has 1048577 bytes");
}

TEST_F(DeviceWire, EvenEmptyMessagesHaveALimit) {
  for (std::size_t i = 0; i < world::most_radio_messages_per_robot; ++i) send(0, "");
  send(2, "");
  EXPECT_FALSE(check());
  send(1, "");
  expect_fault(ErrorCode::too_large, "radio_messages", "a", "or 65536 messages");
}

// ---- observations -------------------------------------------------------------------------------

TEST_F(DeviceWireOfC, SensesWhatIsItsOwn) {
  world::Observations seen = run.observations();
  seen.radio_messages.add(0, bytes_of("for a"));
  seen.radio_messages.add(3, bytes_of("one"));
  seen.radio_messages.add(3, bytes_of(""));
  seen.proximity = {0.1, 0.2, 0.3};
  seen.positioning[1] = {{1, 2, 3}, math::Quaternion(0.5, -0.5, 0.5, -0.5)};
  seen.batteries = {{1, 1}, {1, 1}, {0.25, 60}};
  seen.imus[2] = {{1, 2, 3}, {4, 5, 6}};
  seen.contact_sensors[1] = {1, {2, 3, 4}, 9};
  seen.range_and_bearing_data = {1, 2, 3, 4, 5, 6, 7, 8};
  seen.range_and_bearing = {{0, 1, 1, 1, {0, 4}}, {2, 1.5, -0.5, 0.25, {4, 4}}};
  Outbox outbox;
  ASSERT_TRUE(outbox.observation(roster, seen, {}));
  const auto observation = told(outbox).observation();
  ASSERT_EQ(observation.radio_messages_size(), 2);
  EXPECT_EQ(observation.radio_messages(0).radio(), 1U);
  EXPECT_EQ(observation.radio_messages(0).payload(), "one");
  EXPECT_EQ(observation.radio_messages(1).payload(), "");
  ASSERT_EQ(observation.proximity_size(), 2);
  EXPECT_EQ(observation.proximity(0), 0.2);
  const std::vector<double> pose(observation.positioning().begin(),
                                 observation.positioning().end());
  EXPECT_EQ(pose, (std::vector<double>{1, 2, 3, 0.5, -0.5, 0.5, -0.5}));
  ASSERT_EQ(observation.batteries_size(), 2);
  EXPECT_EQ(observation.batteries(1), 60);
  ASSERT_EQ(observation.imus_size(), 6 * observation.batteries_size() / 2 + 6);  // c has two
  EXPECT_EQ(observation.imus(6 * observation.batteries_size() / 2), 1);
  EXPECT_EQ(*observation.imus().rbegin(), 6);
  EXPECT_EQ(*observation.contact_sensors().rbegin(), 9);
  ASSERT_EQ(observation.range_and_bearing_size(), 1);
  const auto& packet = observation.range_and_bearing(0);
  EXPECT_EQ(packet.robot(), 0U);
  EXPECT_EQ(packet.range(), 1.5);
  EXPECT_EQ(packet.horizontal_bearing(), -0.5);
  EXPECT_EQ(packet.vertical_bearing(), 0.25);
  EXPECT_EQ(packet.data(), "\x05\x06\x07\x08");
}

TEST_F(DeviceWire, ReceiversKeepTheirPlacesAroundRobotsWithoutDevices) {
  world::Observations seen = run.observations();
  seen.radio_messages.add(1, bytes_of("for a"));
  seen.radio_messages.add(3, bytes_of("for c"));
  seen.range_and_bearing_data.resize(4);
  seen.range_and_bearing = {{0, 1, 0, 0, {0, 4}}, {2, 2, 0, 0, {0, 4}}};
  Outbox outbox;
  ASSERT_TRUE(outbox.observation(roster, seen, {}));
  const auto observation = told(outbox).observation();
  EXPECT_EQ(observation.radio_messages(0).radio(), 1U);
  EXPECT_EQ(observation.radio_messages(1).radio(), 3U);
  EXPECT_EQ(observation.range_and_bearing(0).robot(), 0U);
  EXPECT_EQ(observation.range_and_bearing(1).robot(), 2U);
}

// The data of the same sender are copied for each packet, and each message takes memory beside its
// content.
TEST_F(DeviceWire, WhatItHearsCountsBeforeAMessageIsMade) {
  world::Observations seen = run.observations();
  seen.range_and_bearing_data.resize(65536);
  seen.range_and_bearing.assign(1000, {0, 1, 0, 0, {0, 65536}});
  Outbox outbox;
  EXPECT_TRUE(outbox.observation(roster, seen, {}));
  seen.range_and_bearing.assign(17000, {0, 1, 0, 0, {0, 65536}});
  EXPECT_FALSE(outbox.observation(roster, seen, {})) << "more than 1 GiB of data";
  seen.range_and_bearing.clear();
  seen.radio_messages.add(1, {});
  seen.radio_messages.entries.assign(1000, seen.radio_messages.entries[0]);
  EXPECT_TRUE(outbox.observation(roster, seen, {}, 64'000));
  EXPECT_FALSE(outbox.observation(roster, seen, {}, 31'999))
      << "32 bytes each, though they are 4 bytes in the message";
}

TEST_F(DeviceWire, ASessionThatHearsTooMuchGetsNoMessage) {
  world::Observations seen = run.observations();
  seen.radio_messages.add(3, bytes_of(std::string(world::most_radio_message_bytes, 'x')));
  const auto entry = seen.radio_messages.entries[0];
  seen.radio_messages.entries.assign(1025, entry);  // of the same bytes
  Outbox outbox;
  EXPECT_FALSE(outbox.observation(roster, seen, {}));
  seen.radio_messages.entries.resize(2);
  EXPECT_TRUE(outbox.observation(roster, seen, {}));
}

// ---- descriptions -------------------------------------------------------------------------------

TEST_F(DeviceWire, WelcomeDescribesThem) {
  Outbox outbox;
  outbox.welcome(run.run(), roster, Welcome{"token", 0, Role::controller, 0, 0, {}});
  const auto welcome = told(outbox).welcome();
  const v1::RobotDescription& a = welcome.robots(0);
  const v1::RobotDescription& b = welcome.robots(1);
  const v1::RobotDescription& c = welcome.robots(2);
  EXPECT_EQ(b.radios_size() + b.leds_size() + b.tags_size() + b.magnets_size(), 0);
  EXPECT_FALSE(b.has_range_and_bearing() || b.positioning() || b.battery());
  ASSERT_EQ(c.radios_size(), 2);
  EXPECT_EQ(c.radios(0).id(), "radio2");
  EXPECT_EQ(c.radios(0).range(), 0.5);
  EXPECT_TRUE(c.radios(0).sends() && !c.radios(0).receives());
  EXPECT_TRUE(c.radios(1).receives() && !c.radios(1).sends());
  ASSERT_EQ(c.leds_size(), 2);
  EXPECT_EQ(c.leds(1).id(), "led3");
  EXPECT_EQ(c.leds(1).color(), 0x030609U);
  EXPECT_EQ(c.directional_leds(0).id(), "directional1");
  EXPECT_EQ(c.tags(1).payload(), "payload3");
  EXPECT_EQ(c.magnets(0).id(), "magnet2");
  ASSERT_EQ(a.proximity_sensors_size(), 1);
  EXPECT_EQ(a.proximity_sensors(0).anchor(), "base");
  EXPECT_EQ(a.proximity_sensors(0).direction_size(), 3);
  EXPECT_EQ(c.proximity_sensors(0).anchor(), "origin");
  EXPECT_EQ(c.proximity_sensors(0).range(), 0.2);
  EXPECT_FALSE(a.proximity_sensors(0).has_angle());
  EXPECT_EQ(c.proximity_sensors(0).angle(), -2.5);
  EXPECT_EQ(a.range_and_bearing().data_size(), 4U);
  EXPECT_TRUE(a.range_and_bearing().sends() && a.range_and_bearing().receives());
  EXPECT_TRUE(a.positioning() && a.battery());
  ASSERT_EQ(c.contact_sensors_size(), 1);
  EXPECT_EQ(c.contact_sensors(0).id(), "skin1");
  EXPECT_EQ(c.contact_sensors(0).anchor(), "origin");
  ASSERT_EQ(c.imus_size(), 2);
  EXPECT_EQ(c.imus(0).anchor(), "origin");
  EXPECT_EQ(c.imus(1).id(), "imu2");
  EXPECT_EQ(c.imus(1).anchor(), "base");
  EXPECT_EQ(c.imus(1).position(2), 3);
  EXPECT_EQ(c.imus(1).orientation(2), 1);
}

}  // namespace
}  // namespace ziggurat::wire
