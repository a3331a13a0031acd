// SPDX-License-Identifier: MIT
#pragma once
// Layout of two robots with devices that describe themselves: two lamps each, which read a value
// and take a power, and an ear, which reads rows.

#include "world/commands.h"
#include "world/layout.h"

namespace ziggurat {

inline constexpr world::DeviceKind lamp_kind{.name = "lamp",
                                             .readings = {{"value"}, {"heat", "K"}},
                                             .commands = {{"power", "W", -1, 1, 0.5, 0.25}},
                                             .properties = {{"angle", "rad"}}};
inline constexpr world::DeviceKind ear_kind{
    .name = "ear", .readings = {{"pitch", "Hz"}, {"color", "0xRRGGBB"}}, .most_rows = 9};

/// Readings of robot r begin at 4 r, commands at 2 r, its ear is list r.
inline world::Layout described_layout() {
  world::Layout layout;
  for (const char* id : {"a", "b"}) {
    world::RobotLayout robot;
    robot.id = id;
    robot.entity = layout.entities.size();
    layout.entities.push_back({id, {}, false});
    robot.described = {layout.described.size(), 3};
    robot.device_readings = {layout.device_readings, 4};
    robot.device_commands = {layout.device_commands.size(), 2};
    robot.device_lists = {layout.device_lists, 1};
    for (const char* side : {"left", "right"}) {
      world::DescribedDevice& lamp = layout.described.emplace_back();
      lamp.kind = &lamp_kind;
      lamp.id = side;
      lamp.mount = {robot.entity, {}, {{1, 2, 3}, math::Quaternion::Identity()}};
      lamp.properties = {0.75};
      lamp.readings = {layout.device_readings, 2};
      lamp.commands = {layout.device_commands.size(), 1};
      layout.device_readings += 2;
      layout.device_commands.push_back(lamp_kind.commands.begin());
    }
    world::DescribedDevice& ear = layout.described.emplace_back();
    ear.kind = &ear_kind;
    ear.mount.entity = robot.entity;
    ear.rows = {layout.device_lists++, 1};
    layout.robots.push_back(robot);
  }
  return layout;
}

/// Readings 1, 2, …; a's ear reads two rows, b's none.
inline world::Observations described_observations() {
  world::Observations seen;
  for (int i = 1; i <= 8; ++i) seen.device_readings.push_back(i);
  seen.device_rows = {{2, {440, 0xFF0000, 880, 0x00FF00}}, {2, {}}};
  return seen;
}

}  // namespace ziggurat
