#include "recording/reading.h"

#include <algorithm>
#include <span>

#include "recording/reading_cameras.h"
#include "ziggurat/v1/envelope.h"

namespace ziggurat::recording {

v1::Color color_of(world::Color packed) {
  v1::Color color;
  color.set_red(packed >> 16 & 0xFF);
  color.set_green(packed >> 8 & 0xFF);
  color.set_blue(packed & 0xFF);
  return color;
}

namespace {

void add_colors(const std::vector<world::Color>& colors, const world::Range& range,
                google::protobuf::RepeatedPtrField<v1::Color>& out) {
  for (std::size_t i = range.begin; i < range.end(); ++i) *out.Add() = color_of(colors[i]);
}

void add_payloads(const std::vector<std::string>& payloads, const world::Range& range,
                  google::protobuf::RepeatedPtrField<std::string>& out) {
  for (std::size_t i = range.begin; i < range.end(); ++i) *out.Add() = v1::valid_utf8(payloads[i]);
}

void add_bytes(std::span<const std::uint8_t> bytes,
               google::protobuf::RepeatedField<std::uint32_t>& out) {
  out.Add(bytes.begin(), bytes.end());
}

using MessageMap = google::protobuf::Map<std::string, v1::Messages>;

/// Entries of a robot's radios that `uses` says; those may stand in any order of radios.
template <class Uses>
void add_messages(const Moment& moment, const world::Range& radios,
                  const world::RadioMessages& messages, Uses uses, MessageMap& out) {
  for (std::size_t i = radios.begin; i < radios.end(); ++i) {
    const world::RadioLayout& radio = moment.layout.radios[i];
    if (uses(radio)) out[v1::valid_utf8(radio.id)];
  }
  for (const auto& entry : messages.entries) {
    if (entry.radio < radios.begin || entry.radio >= radios.end()) continue;
    v1::Messages& list = out[v1::valid_utf8(moment.layout.radios[entry.radio].id)];
    add_bytes(messages.payload(entry), *list.add_messages()->mutable_bytes());
  }
}

void add_packets(const Moment& moment, const world::Range& devices, v1::RobotObservation& out) {
  const auto& observations = moment.observations;
  for (const world::RangeAndBearingPacket& packet : observations.range_and_bearing) {
    if (packet.receiver < devices.begin || packet.receiver >= devices.end()) continue;
    v1::Packet& to = *out.add_range_and_bearing();
    to.set_range(packet.range);
    to.set_horizontal_bearing(packet.horizontal_bearing);
    to.set_vertical_bearing(packet.vertical_bearing);
    add_bytes(std::span(observations.range_and_bearing_data)
                  .subspan(packet.data.begin, packet.data.count),
              *to.mutable_data());
  }
}

void fill_pose(const math::Pose& from, v1::Pose& to) {
  to.set_x(from.position.x());
  to.set_y(from.position.y());
  to.set_z(from.position.z());
  to.set_qw(from.orientation.w());
  to.set_qx(from.orientation.x());
  to.set_qy(from.orientation.y());
  to.set_qz(from.orientation.z());
}

void add_driving(const Moment& moment, const world::RobotLayout& robot, v1::RobotObservation& out) {
  for (std::size_t i = robot.wheels.begin; i < robot.wheels.end(); ++i) {
    if (!moment.layout.wheels[i].measures) continue;
    const world::WheelsReading& from = moment.observations.wheels[i];
    v1::Wheels& to = *out.mutable_wheels();
    to.set_velocity_left(from.velocity_left);
    to.set_velocity_right(from.velocity_right);
    to.set_distance_left(from.distance_left);
    to.set_distance_right(from.distance_right);
  }
  for (std::size_t i = robot.turrets.begin; i < robot.turrets.end(); ++i) {
    if (!moment.layout.turrets[i].measures) continue;
    out.set_turret_rotation(moment.observations.turrets[i]);
  }
}

const char* name_of(world::TurretMode mode) {
  switch (mode) {
    case world::TurretMode::passive:
      return "passive";
    case world::TurretMode::position:
      return "position";
    case world::TurretMode::speed:
      return "speed";
  }
  return "";
}

void add_driving(const Moment& moment, const world::RobotLayout& robot, v1::RobotCommand& out) {
  for (std::size_t i = robot.wheels.begin; i < robot.wheels.end(); ++i) {
    if (!moment.layout.wheels[i].drives) continue;
    out.mutable_wheels()->set_left(moment.commands.wheels[i].left);
    out.mutable_wheels()->set_right(moment.commands.wheels[i].right);
  }
  for (std::size_t i = robot.turrets.begin; i < robot.turrets.end(); ++i) {
    if (!moment.layout.turrets[i].drives) continue;
    const world::TurretCommand& from = moment.commands.turrets[i];
    out.mutable_turret()->set_mode(name_of(from.mode));
    out.mutable_turret()->set_rotation(from.rotation);
    out.mutable_turret()->set_speed(from.speed);
  }
}

void fill_observation(const Moment& moment, const world::RobotLayout& robot,
                      v1::RobotObservation& out) {
  const world::Observations& sensed = moment.observations;
  for (std::size_t i = robot.joint_sensors.begin; i < robot.joint_sensors.end(); ++i) {
    (*out.mutable_joint_encoders())[moment.layout.joint_sensors[i].id] = sensed.joint_readings[i];
  }
  add_messages(
      moment, robot.radios, sensed.radio_messages,
      [](const world::RadioLayout& radio) { return radio.receives; },
      *out.mutable_radio_messages());
  for (std::size_t i = robot.proximity.begin; i < robot.proximity.end(); ++i) {
    out.add_proximity(sensed.proximity[i]);
  }
  add_packets(moment, robot.range_and_bearing, out);
  if (robot.positioning.count > 0) {
    fill_pose(sensed.positioning[robot.positioning.begin], *out.mutable_positioning());
  }
  if (robot.batteries.count > 0) {
    const world::BatteryReading& battery = sensed.batteries[robot.batteries.begin];
    out.mutable_battery()->set_available_charge(battery.available_charge);
    out.mutable_battery()->set_time_left(battery.time_left);
  }
  add_cameras(moment, robot, *out.mutable_cameras());
  add_driving(moment, robot, out);
  const world::EntityLayout& entity = moment.layout.entities[robot.entity];
  add_colors(moment.state.led_colors, entity.leds, *out.mutable_led_colors());
  add_colors(moment.state.directional_led_colors, entity.directional_leds,
             *out.mutable_directional_led_colors());
  add_payloads(moment.state.tag_payloads, entity.tags, *out.mutable_tag_payloads());
}

void fill_command(const Moment& moment, const world::RobotLayout& robot, v1::RobotCommand& out) {
  const world::Commands& commands = moment.commands;
  for (std::size_t i = robot.joint_actuators.begin; i < robot.joint_actuators.end(); ++i) {
    (*out.mutable_joint_targets())[moment.layout.joint_actuators[i].id] = commands.joint_targets[i];
  }
  add_messages(
      moment, robot.radios, commands.radio_messages,
      [](const world::RadioLayout& radio) { return radio.sends; }, *out.mutable_radio_messages());
  add_colors(commands.led_colors, robot.leds, *out.mutable_led_colors());
  add_colors(commands.directional_led_colors, robot.directional_leds,
             *out.mutable_directional_led_colors());
  add_payloads(commands.tag_payloads, robot.tags, *out.mutable_tag_payloads());
  for (std::size_t i = robot.magnets.begin; i < robot.magnets.end(); ++i) {
    (*out.mutable_magnet_currents())[v1::valid_utf8(moment.layout.magnets[i].id)] =
        commands.magnet_currents[i];
  }
  for (std::size_t i = robot.range_and_bearing.begin; i < robot.range_and_bearing.end(); ++i) {
    const world::RangeAndBearingLayout& device = moment.layout.range_and_bearing[i];
    if (!device.sends) continue;
    add_bytes(
        std::span(commands.range_and_bearing_data).subspan(device.data.begin, device.data.count),
        *out.mutable_range_and_bearing_data());
  }
  add_driving(moment, robot, out);
}

}  // namespace

v1::Reading make_reading(const Moment& moment, std::size_t index) {
  const world::RobotLayout& robot = moment.layout.robots[index];
  v1::Reading reading;
  reading.set_tick(moment.observations.tick);
  reading.set_time_s(static_cast<double>(moment.observations.time_ns) / 1e9);
  reading.set_robot(robot.id);
  fill_observation(moment, robot, *reading.mutable_observation());
  fill_command(moment, robot, *reading.mutable_command());
  return reading;
}

}  // namespace ziggurat::recording
