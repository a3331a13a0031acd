// SPDX-License-Identifier: MIT
// Devices that describe themselves on the wire.

#include <gtest/gtest.h>

#include "../described_devices.h"
#include "wire/command.h"
#include "wire/command_limits.h"
#include "wire/devices.h"
#include "wire/inbox.h"
#include "wire/observation.h"

namespace ziggurat::wire::described {
namespace {

struct DescribedWire : ::testing::Test {
  std::optional<Fault> send(v1::Command command) {
    v1::ClientMessage message;
    *message.mutable_command() = std::move(command);
    EXPECT_EQ(inbox.parse(message.SerializeAsString()), Inbox::Kind::command);
    auto fault = inbox.check(roster, layout);
    if (!fault) inbox.apply(roster, commands);
    return fault;
  }

  const world::Layout layout = described_layout();
  Roster roster = make_roster(layout, std::vector<std::size_t>{0, 1});
  world::Commands commands;
  Inbox inbox;

  DescribedWire() { commands.device_commands = {0.5, 0.5, 0.5, 0.5}; }
};

TEST_F(DescribedWire, AKindIsDescribedOnceWithItsDevices) {
  const std::vector<scene::Controller> controllers(1);
  v1::RobotDescription robot;
  describe({layout, controllers, {}, 1, 1, 10, "", ""}, 1, robot);
  ASSERT_EQ(robot.device_kinds_size(), 2);
  const v1::DeviceKind& lamps = robot.device_kinds(0);
  EXPECT_EQ(lamps.name(), "lamp");
  ASSERT_EQ(lamps.readings_size(), 2);
  EXPECT_EQ(lamps.readings(1).name() + lamps.readings(1).unit(), "heatK");
  ASSERT_EQ(lamps.commands_size(), 1);
  EXPECT_EQ(lamps.commands(0).least(), -1);
  EXPECT_EQ(lamps.commands(0).most(), 1);
  EXPECT_EQ(lamps.commands(0).initial(), 0.5);
  EXPECT_EQ(lamps.commands(0).released(), 0.25);
  EXPECT_EQ(lamps.properties(0).name(), "angle");
  EXPECT_EQ(lamps.most_rows(), 0u);
  ASSERT_EQ(lamps.devices_size(), 2);
  EXPECT_EQ(lamps.devices(1).id(), "right");
  EXPECT_EQ(lamps.devices(1).anchor(), "origin");
  EXPECT_EQ(lamps.devices(1).position(2), 3);
  EXPECT_EQ(lamps.devices(1).orientation_size(), 4);
  EXPECT_EQ(lamps.devices(1).properties(0), 0.75);
  EXPECT_EQ(robot.device_kinds(1).most_rows(), 9u);
  EXPECT_EQ(robot.device_kinds(1).devices_size(), 1);
}

TEST_F(DescribedWire, ReadingsAndRowsArePackedRobotByRobot) {
  v1::Observation told;
  fill(roster, described_observations(), {}, told);
  EXPECT_EQ(std::vector<double>(told.device_readings().begin(), told.device_readings().end()),
            (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8}));
  ASSERT_EQ(told.device_rows_size(), 2);
  EXPECT_EQ(told.device_rows(0), 2u);
  EXPECT_EQ(told.device_rows(1), 0u);
  ASSERT_EQ(told.device_row_values_size(), 4);
  EXPECT_EQ(told.device_row_values(2), 880);
  told.Clear();
  fill(make_roster(layout, std::vector<std::size_t>{1}), described_observations(), {}, told);
  EXPECT_EQ(told.device_readings(0), 5);
  EXPECT_EQ(told.device_rows_size(), 1);
  EXPECT_EQ(told.device_row_values_size(), 0);
}

TEST_F(DescribedWire, RowsCountInTheSizeOfAnObservation) {
  const ReadingSize size = size_of_readings(roster, described_observations(), {});
  EXPECT_EQ(size.size, 4 * sizeof(double));
}

TEST_F(DescribedWire, CommandsOfSomeRobots) {
  v1::Command command;
  command.add_robots(1);
  for (const double value : {0.75, -1.0}) command.add_device_commands(value);
  EXPECT_FALSE(send(command));
  EXPECT_EQ(commands.device_commands, (std::vector<double>{0.5, 0.5, 0.75, -1}));
}

TEST_F(DescribedWire, CommandsOutsideOfTheirLimitsAreRefused) {
  for (const double bad : {1.5, -1.001, static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
    v1::Command command;
    for (const double value : {0.0, 0.0, 0.0, bad}) command.add_device_commands(value);
    const auto fault = send(command);
    ASSERT_TRUE(fault) << bad;
    EXPECT_EQ(fault->code, ErrorCode::bad_value);
    EXPECT_EQ(fault->field, "device_commands");
    EXPECT_EQ(fault->robot, "b");
  }
  v1::Command command;
  for (const double value : {0.0, 0.0, 0.0, 1.5}) command.add_device_commands(value);
  EXPECT_EQ(send(command)->message,
            "The power of lamp 'right' of robot 'b' is 1.5; it must be from -1 to 1.");
  EXPECT_EQ(commands.device_commands, (std::vector<double>(4, 0.5))) << "nothing has an effect";
}

TEST_F(DescribedWire, TooFewOrTooManyCommandsAreRefused) {
  for (const int count : {1, 3, 5}) {
    v1::Command command;
    for (int i = 0; i < count; ++i) command.add_device_commands(0);
    EXPECT_TRUE(send(command)) << count;
  }
}

TEST_F(DescribedWire, ARobotThatLeavesReleasesItsCommands) {
  reset_commands(layout, 0, commands);
  EXPECT_EQ(commands.device_commands, (std::vector<double>{0.25, 0.25, 0.5, 0.5}));
}

TEST_F(DescribedWire, LastCommandsAreToldAsTheyAreRead) {
  v1::Command command;
  add_channels(roster, commands, command);
  EXPECT_EQ(command.device_commands_size(), 4);
  EXPECT_FALSE(send(command));
}

}  // namespace
}  // namespace ziggurat::wire::described
