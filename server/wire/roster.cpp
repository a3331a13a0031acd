#include "wire/roster.h"

#include <algorithm>

namespace ziggurat::wire {
namespace {

/// The bytes that a robot broadcasts, if it has an actuator for that.
world::Range range_and_bearing_data(const world::Layout& layout, const world::RobotLayout& robot) {
  if (robot.range_and_bearing.count == 0) return {};
  const auto& device = layout.range_and_bearing[robot.range_and_bearing.begin];
  return device.sends ? device.data : world::Range{device.data.begin, 0};
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

Roster make_roster(const world::Layout& layout, std::span<const std::size_t> robots) {
  Roster roster;
  roster.robots.assign(robots.begin(), robots.end());
  roster.gone.assign(robots.size(), false);
  for (const std::size_t index : robots) {
    const world::RobotLayout& robot = layout.robots[index];
    roster.joint_sensors.append(robot.joint_sensors);
    roster.joint_actuators.append(robot.joint_actuators);
    roster.radios.append(robot.radios);
    roster.leds.append(robot.leds);
    roster.directional_leds.append(robot.directional_leds);
    roster.tags.append(robot.tags);
    roster.magnets.append(robot.magnets);
    roster.proximity.append(robot.proximity);
    roster.range_and_bearing.append(robot.range_and_bearing);
    roster.range_and_bearing_data.append(range_and_bearing_data(layout, robot));
    roster.positioning.append(robot.positioning);
    roster.batteries.append(robot.batteries);
  }
  return roster;
}

}  // namespace ziggurat::wire
