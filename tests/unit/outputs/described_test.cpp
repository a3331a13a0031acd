// SPDX-License-Identifier: MIT
// Devices that describe themselves, as named values of a reading.

#include <gtest/gtest.h>

#include "../described_devices.h"
#include "outputs/reading.h"

namespace ziggurat::outputs {
namespace {

TEST(DescribedReadings, HaveTheNamesOfTheDescription) {
  const world::Layout layout = described_layout();
  const world::State state;
  const world::Observations seen = described_observations();
  world::Commands commands;
  commands.device_commands = {0.5, -0.5, 0.25, 1};
  const v1::Reading a = make_reading({layout, state, seen, commands}, 0);
  const auto& lamps = a.observation().devices().at("lamp");
  ASSERT_EQ(lamps.devices_size(), 2);
  EXPECT_EQ(lamps.devices(1).id(), "right");
  EXPECT_EQ(lamps.devices(1).values().at("value"), 3);
  EXPECT_EQ(lamps.devices(1).values().at("heat"), 4);
  const auto& ear = a.observation().devices().at("ear").devices(0);
  ASSERT_EQ(ear.rows_size(), 2);
  EXPECT_EQ(ear.rows(1).values().at("pitch"), 880);
  EXPECT_EQ(a.command().devices().at("lamp").devices(1).values().at("power"), -0.5);
  EXPECT_FALSE(a.command().devices().contains("ear")) << "it takes no commands";
  const v1::Reading b = make_reading({layout, state, seen, commands}, 1);
  EXPECT_EQ(b.observation().devices().at("lamp").devices(0).values().at("value"), 5);
  EXPECT_EQ(b.observation().devices().at("ear").devices(0).rows_size(), 0);
  EXPECT_EQ(b.command().devices().at("lamp").devices(1).values().at("power"), 1);
}

}  // namespace
}  // namespace ziggurat::outputs
