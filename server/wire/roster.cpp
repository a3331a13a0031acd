// SPDX-License-Identifier: MIT
#include "wire/roster.h"

#include <fmt/format.h>

#include <algorithm>

#include "wire/messages.h"

namespace ziggurat::wire {
namespace {

/// Appends the robot's values of each channel of a table.
template <class Table>
void append_channels(const Table& table, const world::Layout& layout,
                     const world::RobotLayout& robot, auto& packings) {
  world::for_each_channel(
      table, [&](auto i) { packings[i].append(std::get<i>(table).devices(layout, robot)); });
}

void append_cameras(const world::Layout& layout, const world::RobotLayout& robot, Roster& roster) {
  for (std::size_t i = robot.cameras.begin; i < robot.cameras.end(); ++i) {
    const world::CameraLayout& camera = layout.cameras[i];
    if (camera.leds) roster.led_cameras.push_back(i);
    if (camera.directional_leds) roster.directional_led_cameras.push_back(i);
    if (camera.tags) roster.tag_cameras.push_back(i);
    if (camera.image) roster.image_cameras.push_back(i);
  }
}

}  // namespace

void Packing::append(const world::Range& flat) {
  const Stretch robot{count, flat.begin, flat.count};
  robots.push_back(robot);
  count += flat.count;
  if (flat.count == 0) return;
  if (!stretches.empty() && stretches.back().flat + stretches.back().count == flat.begin) {
    stretches.back().count += flat.count;
  } else {
    stretches.push_back(robot);
  }
}

std::size_t Packing::owner(std::size_t packed) const {
  // The last robot that begins there or before: those without values share their beginning.
  const auto after = std::upper_bound(
      robots.begin(), robots.end(), packed,
      [](std::size_t value, const Stretch& robot) { return value < robot.packed; });
  return static_cast<std::size_t>(after - robots.begin()) - 1;
}

void Roster::leave(std::size_t position) {
  if (gone[position]) return;
  gone[position] = true;
  ++gone_count;
}

void Roster::hand_over(std::size_t position) {
  if (gone[position]) return;
  leave(position);
  taken[position] = true;
}

Roster make_roster(const world::Layout& layout, std::span<const std::size_t> robots) {
  Roster roster;
  roster.robots.assign(robots.begin(), robots.end());
  roster.gone.assign(robots.size(), false);
  roster.taken.assign(robots.size(), false);
  for (const std::size_t index : robots) {
    const world::RobotLayout& robot = layout.robots[index];
    append_channels(world::sensed, layout, robot, roster.sensed);
    append_channels(world::commanded, layout, robot, roster.commanded);
    roster.radios.append(robot.radios);
    roster.range_and_bearing.append(robot.range_and_bearing);
    roster.device_lists.append(robot.device_lists);
    append_cameras(layout, robot, roster);
  }
  return roster;
}

std::optional<Fault> check_position(std::size_t position, const Roster& roster, std::string field) {
  if (position < roster.robots.size()) return std::nullopt;
  return make_fault(ErrorCode::unknown_robot, std::move(field),
                    fmt::format("The session has {} robots; there is none at position {}.",
                                roster.robots.size(), position));
}

}  // namespace ziggurat::wire
