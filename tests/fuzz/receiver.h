// SPDX-License-Identifier: MIT
#pragma once
// A server's handling of a client's bytes, for fuzzers.

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "require.h"
#include "wire/inbox.h"

namespace ziggurat::fuzz {

// Three robots with 2, 0 and 3 of each device; the session holds the first and the last. Each of
// these drives wheels and a turret; wheels and turret 1 are only measured.
inline world::Layout make_layout() {
  world::Layout layout;
  std::size_t devices = 0;
  for (const std::size_t count : {2, 0, 3}) {
    world::RobotLayout robot;
    robot.id = "robot" + std::to_string(layout.robots.size());
    for (world::Range* range : {&robot.joint_actuators, &robot.radios, &robot.leds,
                                &robot.directional_leds, &robot.tags, &robot.magnets}) {
      *range = {devices, count};
    }
    robot.range_and_bearing = {layout.range_and_bearing.size(), count == 0 ? 0U : 1U};
    if (count > 0)
      layout.range_and_bearing.push_back(
          {.mount = {}, .range = 1, .data = {devices, count}, .sends = true, .receives = true});
    if (count > 0) {
      robot.wheels = robot.turrets = {layout.wheels.size(), 1};
      layout.wheels.push_back({.entity = 0, .axle_length = 0.14, .drives = true, .measures = true});
      layout.turrets.push_back({.entity = 0, .drives = true, .measures = true});
    } else {
      layout.wheels.push_back({.entity = 0, .axle_length = 0.14, .measures = true});
      layout.turrets.push_back({.entity = 0, .measures = true});
    }
    layout.robots.push_back(robot);
    devices += count;
  }
  layout.joint_actuators.resize(devices);
  layout.radios.resize(devices);
  for (std::size_t i = 0; i < devices; ++i) layout.radios[i].sends = i != 1;
  layout.leds.resize(devices);
  layout.directional_leds.resize(devices);
  layout.tags.resize(devices);
  layout.magnets.resize(devices);
  return layout;
}

inline world::Commands make_commands(std::size_t devices) {
  world::Commands commands;
  commands.joint_targets.resize(devices);
  commands.led_colors.resize(devices);
  commands.directional_led_colors.resize(devices);
  commands.tag_payloads.resize(devices);
  commands.magnet_currents.resize(devices);
  commands.range_and_bearing_data.resize(devices);
  commands.wheels.resize(3);
  commands.turret_modes.resize(3);
  commands.turret_rotations.resize(3);
  commands.turret_speeds.resize(3);
  return commands;
}

inline void receive_command(const wire::Inbox& inbox, const wire::Roster& roster,
                            const world::Layout& layout) {
  if (inbox.check(roster, layout)) return;
  world::Commands commands = make_commands(layout.joint_actuators.size());
  inbox.apply(roster, commands);
  for (const double target : commands.joint_targets) require(std::isfinite(target));
  for (const double current : commands.magnet_currents) require(std::isfinite(current));
  for (const world::Color color : commands.led_colors) require(color <= 0xFFFFFF);
  for (const world::Color color : commands.directional_led_colors) require(color <= 0xFFFFFF);
  for (const auto& [left, right] : commands.wheels) {
    require(std::isfinite(left) && std::isfinite(right));
  }
  for (const auto mode : commands.turret_modes) require(mode <= world::TurretMode::speed);
  for (const double rotation : commands.turret_rotations) require(std::isfinite(rotation));
  for (const double speed : commands.turret_speeds) require(std::isfinite(speed));
  require(commands.wheels[1].left == 0 && commands.turret_speeds[1] == 0);
  for (const auto& entry : commands.radio_messages.entries) {
    require(entry.radio < layout.radios.size() && layout.radios[entry.radio].sends);
    commands.radio_messages.payload(entry);
  }
  std::vector<wire::LogLine> lines;
  inbox.append_log(roster, lines);
  for (const wire::LogLine& line : lines) require(line.robot < layout.robots.size());
}

/// Must not crash. A command that passes the check must write to values of the session's robots
/// only, and only finite values.
inline void receive(std::string_view bytes) {
  static const world::Layout layout = make_layout();
  static const std::vector<std::size_t> held{0, 2};
  static const wire::Roster roster = wire::make_roster(layout, held);
  static wire::Inbox
      inbox;  // one for all inputs, as in a session: messages must not affect later ones
  switch (inbox.parse(bytes)) {
    case wire::Inbox::Kind::malformed:
    case wire::Inbox::Kind::too_large:
      break;
    case wire::Inbox::Kind::hello:
      inbox.hello();
      break;
    case wire::Inbox::Kind::command:
      receive_command(inbox, roster, layout);
      break;
    case wire::Inbox::Kind::leave:
      inbox.leave();
      inbox.check(roster, layout);
      break;
    case wire::Inbox::Kind::heartbeat:
      inbox.heartbeat();
      break;
    case wire::Inbox::Kind::direction:
      if (!inbox.check_direction()) inbox.direction();
      break;
    case wire::Inbox::Kind::request:
      inbox.request_id();
      inbox.request();
      break;
  }
}

}  // namespace ziggurat::fuzz
