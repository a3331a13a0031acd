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

/// The robot's one device, if the controller uses it so.
world::Range only_if(bool used, const world::Range& device) {
  return {device.begin, used ? device.count : 0};
}

void append_driving(const world::Layout& layout, const world::RobotLayout& robot, Roster& roster) {
  const bool has_wheels = robot.wheels.count > 0;
  const world::WheelsLayout wheels =
      has_wheels ? layout.wheels[robot.wheels.begin] : world::WheelsLayout{};
  roster.wheel_actuators.append(only_if(wheels.drives, robot.wheels));
  roster.wheel_sensors.append(only_if(wheels.measures, robot.wheels));
  const bool has_turret = robot.turrets.count > 0;
  const world::TurretLayout turret =
      has_turret ? layout.turrets[robot.turrets.begin] : world::TurretLayout{};
  roster.turret_actuators.append(only_if(turret.drives, robot.turrets));
  roster.turret_encoders.append(only_if(turret.measures, robot.turrets));
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
    append_driving(layout, robot, roster);
    append_cameras(layout, robot, roster);
  }
  return roster;
}

}  // namespace ziggurat::wire
