// SPDX-License-Identifier: MIT
#include "wire/devices.h"

#include <tuple>

#include "wire/channels.h"
#include "ziggurat/v1/envelope.h"

namespace ziggurat::wire {
namespace {

// --- which field carries which channel ----------------------------------------------------------

constexpr std::tuple observation_fields{
    ObservationField{&world::Observations::joint_readings,
                     &v1::Observation::mutable_joint_readings},
    ObservationField{&world::Observations::proximity, &v1::Observation::mutable_proximity},
    ObservationField{&world::Observations::positioning, &v1::Observation::mutable_positioning},
    ObservationField{&world::Observations::batteries, &v1::Observation::mutable_batteries},
    ObservationField{&world::Observations::wheels, &v1::Observation::mutable_wheels},
    ObservationField{&world::Observations::turrets, &v1::Observation::mutable_turret_rotations},
    ObservationField{&world::Observations::imus, &v1::Observation::mutable_imus},
    ObservationField{&world::Observations::contact_sensors,
                     &v1::Observation::mutable_contact_sensors},
    ObservationField{&world::Observations::device_readings,
                     &v1::Observation::mutable_device_readings},
};

constexpr std::tuple command_fields{
    CommandField{&world::Commands::joint_targets, &v1::Command::joint_targets,
                 &v1::Command::mutable_joint_targets},
    CommandField{&world::Commands::led_colors, &v1::Command::led_colors,
                 &v1::Command::mutable_led_colors},
    CommandField{&world::Commands::directional_led_colors, &v1::Command::directional_led_colors,
                 &v1::Command::mutable_directional_led_colors},
    CommandField{&world::Commands::tag_payloads, &v1::Command::tag_payloads,
                 &v1::Command::mutable_tag_payloads},
    CommandField{&world::Commands::magnet_currents, &v1::Command::magnet_currents,
                 &v1::Command::mutable_magnet_currents},
    CommandField{&world::Commands::range_and_bearing_data, &v1::Command::range_and_bearing_data,
                 &v1::Command::mutable_range_and_bearing_data},
    CommandField{&world::Commands::wheels, &v1::Command::wheel_velocities,
                 &v1::Command::mutable_wheel_velocities},
    CommandField{&world::Commands::turret_modes, &v1::Command::turret_modes,
                 &v1::Command::mutable_turret_modes},
    CommandField{&world::Commands::turret_rotations, &v1::Command::turret_rotations,
                 &v1::Command::mutable_turret_rotations},
    CommandField{&world::Commands::turret_speeds, &v1::Command::turret_speeds,
                 &v1::Command::mutable_turret_speeds},
    CommandField{&world::Commands::device_commands, &v1::Command::device_commands,
                 &v1::Command::mutable_device_commands},
};

// --- descriptions in Welcome --------------------------------------------------------------------

v1::JointDescription::Mode mode_of(bool disabled, bool velocity) {
  if (disabled) return v1::JointDescription::DISABLED;
  return velocity ? v1::JointDescription::VELOCITY : v1::JointDescription::POSITION;
}

void describe_joints(const world::Layout& all, const world::RobotLayout& robot,
                     v1::RobotDescription& description) {
  for (std::size_t i = robot.joint_sensors.begin; i < robot.joint_sensors.end(); ++i) {
    const world::JointSensorLayout& sensor = all.joint_sensors[i];
    v1::JointDescription& joint = *description.add_joint_sensors();
    joint.set_id(v1::valid_utf8(sensor.id));
    joint.set_mode(mode_of(sensor.disabled, sensor.velocity));
  }
  for (std::size_t i = robot.joint_actuators.begin; i < robot.joint_actuators.end(); ++i) {
    const world::JointActuatorLayout& actuator = all.joint_actuators[i];
    v1::JointDescription& joint = *description.add_joint_actuators();
    joint.set_id(v1::valid_utf8(actuator.id));
    joint.set_mode(mode_of(actuator.disabled, actuator.velocity));
    joint.set_max_impulse(actuator.max_impulse);
  }
}

void describe_radios(const world::Layout& all, const world::RobotLayout& robot,
                     v1::RobotDescription& description) {
  for (std::size_t i = robot.radios.begin; i < robot.radios.end(); ++i) {
    v1::RadioDescription& radio = *description.add_radios();
    radio.set_id(v1::valid_utf8(all.radios[i].id));
    radio.set_range(all.radios[i].range);
    radio.set_sends(all.radios[i].sends);
    radio.set_receives(all.radios[i].receives);
  }
  if (robot.range_and_bearing.count == 0) return;
  const world::RangeAndBearingLayout& device = all.range_and_bearing[robot.range_and_bearing.begin];
  v1::RangeAndBearingDescription& to = *description.mutable_range_and_bearing();
  to.set_range(device.range);
  to.set_data_size(static_cast<std::uint32_t>(device.data.count));
  to.set_sends(device.sends);
  to.set_receives(device.receives);
}

void describe_lights_and_tags(const world::Layout& all, const world::RobotLayout& robot,
                              v1::RobotDescription& description) {
  for (std::size_t i = robot.leds.begin; i < robot.leds.end(); ++i) {
    v1::LedDescription& led = *description.add_leds();
    led.set_id(v1::valid_utf8(all.leds[i].id));
    led.set_color(all.leds[i].color);
  }
  for (std::size_t i = robot.directional_leds.begin; i < robot.directional_leds.end(); ++i) {
    v1::LedDescription& led = *description.add_directional_leds();
    led.set_id(v1::valid_utf8(all.directional_leds[i].id));
    led.set_color(all.directional_leds[i].color);
  }
  for (std::size_t i = robot.tags.begin; i < robot.tags.end(); ++i) {
    v1::TagDescription& tag = *description.add_tags();
    tag.set_id(v1::valid_utf8(all.tags[i].id));
    tag.set_payload(all.tags[i].payload);
  }
}

std::string anchor_of(const world::Layout& all, const world::Mount& mount) {
  return mount.link ? v1::valid_utf8(all.links[*mount.link].id) : "origin";
}

/// Describes the mount of a device: anchor, position, orientation.
template <class Description>
void describe_mount(const world::Layout& all, const world::Mount& mount, Description& to) {
  to.set_anchor(anchor_of(all, mount));
  for (const double value : mount.pose.position) to.add_position(value);
  const math::Quaternion& turned = mount.pose.orientation;
  for (const double value : {turned.w(), turned.x(), turned.y(), turned.z()}) {
    to.add_orientation(value);
  }
}

void describe_proximity(const world::Layout& all, const world::RobotLayout& robot,
                        v1::RobotDescription& description) {
  for (std::size_t i = robot.proximity.begin; i < robot.proximity.end(); ++i) {
    const world::ProximityLayout& sensor = all.proximity[i];
    v1::ProximityDescription& to = *description.add_proximity_sensors();
    to.set_anchor(anchor_of(all, sensor.mount));
    for (const double value : sensor.mount.pose.position) to.add_position(value);
    for (const double value : sensor.direction) to.add_direction(value);
    to.set_range(sensor.range);
    if (sensor.angle) to.set_angle(*sensor.angle);
  }
}

void describe_cameras(const world::Layout& all, const world::RobotLayout& robot,
                      v1::RobotDescription& description) {
  for (std::size_t i = robot.cameras.begin; i < robot.cameras.end(); ++i) {
    const world::CameraLayout& camera = all.cameras[i];
    v1::CameraDescription& to = *description.add_cameras();
    to.set_id(v1::valid_utf8(camera.id));
    describe_mount(all, camera.mount, to);
    to.set_near(camera.near);
    to.set_far(camera.far);
    for (const double value : camera.focal_length) to.add_focal_length(value);
    for (const double value : camera.principal_point) to.add_principal_point(value);
    to.set_width(camera.resolution[0]);
    to.set_height(camera.resolution[1]);
    to.set_detects_leds(camera.leds.has_value());
    to.set_detects_directional_leds(camera.directional_leds.has_value());
    to.set_detects_tags(camera.tags.has_value());
    to.set_image(camera.image);
  }
}

void describe_imus(const world::Layout& all, const world::RobotLayout& robot,
                   v1::RobotDescription& description) {
  for (std::size_t i = robot.imus.begin; i < robot.imus.end(); ++i) {
    const world::ImuLayout& imu = all.imus[i];
    v1::ImuDescription& to = *description.add_imus();
    to.set_id(v1::valid_utf8(imu.id));
    describe_mount(all, imu.mount, to);
  }
}

void describe_contact_sensors(const world::Layout& all, const world::RobotLayout& robot,
                              v1::RobotDescription& description) {
  for (std::size_t i = robot.contact_sensors.begin; i < robot.contact_sensors.end(); ++i) {
    v1::ContactSensorDescription& to = *description.add_contact_sensors();
    to.set_id(v1::valid_utf8(all.contact_sensors[i].id));
    to.set_anchor(v1::valid_utf8(all.contact_sensors[i].anchor));
  }
}

void describe_fields(std::initializer_list<world::DeviceField> fields,
                     google::protobuf::RepeatedPtrField<v1::DeviceField>& to) {
  for (const world::DeviceField& field : fields) {
    v1::DeviceField& described = *to.Add();
    described.set_name(field.name);
    described.set_unit(field.unit);
  }
}

/// @param first  a device of the kind: all of a robot are sensed and set alike
void describe_kind(const world::DescribedDevice& first, v1::DeviceKind& to) {
  const world::DeviceKind& kind = *first.kind;
  to.set_name(kind.name);
  describe_fields(kind.properties, *to.mutable_properties());
  if (first.measures()) {
    describe_fields(kind.readings, *to.mutable_readings());
    to.set_most_rows(static_cast<std::uint32_t>(kind.most_rows));
  }
  if (first.commands.count == 0) return;
  for (const world::DeviceCommand& command : kind.commands) {
    v1::DeviceCommand& described = *to.add_commands();
    described.set_name(command.name);
    described.set_unit(command.unit);
    described.set_least(command.least);
    described.set_most(command.most);
    described.set_initial(command.initial);
    described.set_released(command.released);
  }
}

void describe_itself(const world::Layout& all, const world::RobotLayout& robot,
                     v1::RobotDescription& description) {
  const world::DeviceKind* last = nullptr;
  for (std::size_t i = robot.described.begin; i < robot.described.end(); ++i) {
    const world::DescribedDevice& device = all.described[i];
    if (device.kind != last) describe_kind(device, *description.add_device_kinds());
    last = device.kind;
    const int kinds = description.device_kinds_size();
    v1::DescribedDevice& to = *description.mutable_device_kinds(kinds - 1)->add_devices();
    to.set_id(v1::valid_utf8(device.id));
    describe_mount(all, device.mount, to);
    to.mutable_properties()->Add(device.properties.begin(), device.properties.end());
  }
}

void describe_driving(const world::Layout& all, const world::RobotLayout& robot,
                      v1::RobotDescription& description) {
  if (robot.wheels.count > 0) {
    const world::WheelsLayout& wheels = all.wheels[robot.wheels.begin];
    v1::WheelsDescription& to = *description.mutable_wheels();
    to.set_axle_length(wheels.axle_length);
    to.set_drives(wheels.drives);
    to.set_measures(wheels.measures);
  }
  if (robot.turrets.count > 0) {
    const world::TurretLayout& turret = all.turrets[robot.turrets.begin];
    description.mutable_turret()->set_drives(turret.drives);
    description.mutable_turret()->set_measures(turret.measures);
  }
}

}  // namespace

void describe(const Run& run, std::size_t robot, v1::RobotDescription& description) {
  const world::RobotLayout& layout = run.layout.robots[robot];
  description.set_id(v1::valid_utf8(layout.id));
  description.set_controller(v1::valid_utf8(run.controllers[layout.controller].id));
  for (const auto& [name, value] : layout.params) {
    v1::Parameter& parameter = *description.add_params();
    parameter.set_name(v1::valid_utf8(name));
    parameter.set_value(v1::valid_utf8(value));
  }
  if (robot < run.scripts.size()) description.set_script(v1::valid_utf8(run.scripts[robot]));
  describe_joints(run.layout, layout, description);
  describe_radios(run.layout, layout, description);
  describe_lights_and_tags(run.layout, layout, description);
  describe_proximity(run.layout, layout, description);
  describe_cameras(run.layout, layout, description);
  describe_driving(run.layout, layout, description);
  describe_imus(run.layout, layout, description);
  describe_contact_sensors(run.layout, layout, description);
  describe_itself(run.layout, layout, description);
  for (std::size_t i = layout.magnets.begin; i < layout.magnets.end(); ++i) {
    description.add_magnets()->set_id(v1::valid_utf8(run.layout.magnets[i].id));
  }
  description.set_positioning(layout.positioning.count > 0);
  description.set_battery(layout.batteries.count > 0);
  description.set_draws_markers(layout.draws_markers);
}

bool fit_into_welcome(const Run& run, std::span<const std::size_t> robots) {
  constexpr std::size_t most_bytes = std::size_t{64} << 20, header = 16;
  std::size_t bytes = 0;
  v1::RobotDescription description;
  for (const std::size_t robot : robots) {
    description.Clear();
    describe(run, robot, description);
    bytes += description.ByteSizeLong() + header;
    if (bytes > most_bytes) return false;
  }
  return true;
}

// --- values -------------------------------------------------------------------------------------

void add_channels(const Roster& roster, const world::Observations& from, v1::Observation& to) {
  world::for_each_channel(world::sensed, [&](auto i) {
    constexpr const auto& field = field_of<observation_fields, world::sensed, i>();
    add(roster.sensed[i], from.*field.values, *(to.*field.packed)());
  });
}

void add_channels(const Roster& roster, const world::Commands& from, v1::Command& to) {
  world::for_each_channel(world::commanded, [&](auto i) {
    constexpr const auto& field = field_of<command_fields, world::commanded, i>();
    add_all(roster.commanded[i], from.*field.values, *(to.*field.to_fill)());
  });
}

std::size_t payload_bytes(const Roster& roster, const world::Commands& from) {
  constexpr std::size_t row = world::row_of(world::commanded, &world::Commands::tag_payloads);
  std::size_t bytes = 0;
  for (const Packing::Stretch& piece : roster.commanded[row].stretches) {
    for (std::size_t i = 0; i < piece.count; ++i) bytes += from.tag_payloads[piece.flat + i].size();
  }
  return bytes;
}

namespace {

/// The device that the command at a place of Commands::device_commands belongs to.
const world::DescribedDevice& device_of(const world::Layout& layout, const world::Range& devices,
                                        std::size_t command) {
  std::size_t i = devices.begin;
  while (layout.described[i].commands.end() <= command) ++i;
  return layout.described[i];
}

/// Each command of a described device is within its limits; the first that is not is named.
std::optional<Fault> check_device_commands(const v1::Command& command, const Roster& roster,
                                           const world::Layout& layout) {
  constexpr std::size_t row = world::row_of(world::commanded, &world::Commands::device_commands);
  for (int i = 0; i < command.device_commands_size(); ++i) {
    const auto [robot, place] =
        owner(command, roster, layout, roster.commanded[row], static_cast<std::size_t>(i));
    const world::DeviceCommand& field = *layout.device_commands[place];
    const double value = command.device_commands(i);
    if (field.least <= value && value <= field.most) continue;
    const world::DescribedDevice& device = device_of(layout, robot->described, place);
    return make_fault(
        ErrorCode::bad_value, "device_commands",
        fmt::format("The {} of {}{} of robot '{}' is {}; it must be from {} to {}.", field.name,
                    device.kind->name, device.id.empty() ? "" : fmt::format(" '{}'", device.id),
                    robot->id, value, field.least, field.most),
        robot->id);
  }
  return std::nullopt;
}

}  // namespace

std::optional<Fault> check_channels(const v1::Command& command, const Roster& roster,
                                    const world::Layout& layout) {
  std::optional<Fault> found;
  world::for_each_channel(world::commanded, [&](auto i) {
    constexpr const auto& field = field_of<command_fields, world::commanded, i>();
    if (found) return;
    found = check_count(command, roster.commanded[i], std::get<i>(world::commanded),
                        (command.*field.packed)());
  });
  world::for_each_channel(world::commanded, [&](auto i) {
    constexpr const auto& field = field_of<command_fields, world::commanded, i>();
    if (found) return;
    found = check_values(command, roster, layout, roster.commanded[i],
                         std::get<i>(world::commanded), (command.*field.packed)());
  });
  return found ? found : check_device_commands(command, roster, layout);
}

void apply_channels(const v1::Command& command, const Roster& roster, world::Commands& commands) {
  world::for_each_channel(world::commanded, [&](auto i) {
    constexpr const auto& field = field_of<command_fields, world::commanded, i>();
    apply(command, roster, roster.commanded[i], (command.*field.packed)(), commands.*field.values);
  });
}

}  // namespace ziggurat::wire
