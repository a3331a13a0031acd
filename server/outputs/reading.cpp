// SPDX-License-Identifier: MIT
// Fields of values are found by name: the type of a field decides how a value is written. A map is
// keyed by the devices' ids, a message gets a value's numbers in the order of its fields.

#include "outputs/reading.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <algorithm>
#include <cassert>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "ziggurat/v1/envelope.h"

namespace ziggurat::outputs {
namespace {

using CameraMap = google::protobuf::Map<std::string, v1::CameraReading>;

v1::Color color_of(world::Color packed) {
  v1::Color color;
  color.set_red(packed >> 16 & 0xFF);
  color.set_green(packed >> 8 & 0xFF);
  color.set_blue(packed & 0xFF);
  return color;
}

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

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

const FieldDescriptor& field_of(const Message& message, std::string_view name) {
  const FieldDescriptor* field = message.GetDescriptor()->FindFieldByName(std::string(name));
  assert(field && "a name in the tables of world/ is not in recording.proto");
  return *field;
}

/// The message of a field: a new one if the field is repeated.
Message& message_in(Message& message, const FieldDescriptor& field) {
  const auto& reflection = *message.GetReflection();
  return field.is_repeated() ? *reflection.AddMessage(&message, &field)
                             : *reflection.MutableMessage(&message, &field);
}

void write(Message& message, const FieldDescriptor& field, double value) {
  const auto& reflection = *message.GetReflection();
  if (field.is_repeated()) return reflection.AddDouble(&message, &field, value);
  reflection.SetDouble(&message, &field, value);
}

void write(Message& message, const FieldDescriptor& field, const std::string& value) {
  message.GetReflection()->AddString(&message, &field, v1::valid_utf8(value));
}

void write(Message& message, const FieldDescriptor& field, std::uint8_t value) {
  message.GetReflection()->AddUInt32(&message, &field, value);
}

void write(Message& message, const FieldDescriptor& field, world::TurretMode value) {
  message.GetReflection()->SetString(&message, &field, name_of(value));
}

void write(Message& message, const FieldDescriptor& field, world::Color value) {
  message_in(message, field).CopyFrom(color_of(value));
}

template <class T>
requires(world::width<T> > 1) void write(Message& message, const FieldDescriptor& field,
                                         const T& value) {
  Message& part = message_in(message, field);
  int next = 0;
  for (const double number : world::numbers(value)) {
    write(part, *part.GetDescriptor()->field(next++), number);
  }
}

/// @param id  null: the field is not a map
template <class T>
void write(Message& message, const FieldDescriptor& field, const std::string* id, const T& value) {
  if (!id || !field.is_map()) return write(message, field, value);
  Message& entry = *message.GetReflection()->AddMessage(&message, &field);
  entry.GetReflection()->SetString(&entry, field.message_type()->map_key(), v1::valid_utf8(*id));
  write(entry, *field.message_type()->map_value(), value);
}

/// @param name  of a field, or of a field in a message: "turret.speed"
template <class T>
void write(Message& message, std::string_view name, const std::string* id, const T& value) {
  const std::size_t dot = name.find('.');
  if (dot == std::string_view::npos) return write(message, field_of(message, name), id, value);
  write(message_in(message, field_of(message, name.substr(0, dot))), name.substr(dot + 1), id,
        value);
}

/// Id of a device; none for values that are recorded by position.
std::optional<std::string> id_in(const world::DeviceLists& lists, world::IdOf id,
                                 std::size_t device) {
  if (!id) return std::nullopt;
  return id(lists, device);
}

/// A joint may have a sensor of its position and one of its velocity: the one that is listed later
/// is recorded as "ID position" or "ID velocity".
std::string id_of_sensor(const world::DeviceLists& lists, const world::Range& range,
                         std::size_t device) {
  const auto& sensors = lists.joint_sensors;
  const world::JointSensorLayout& sensor = sensors[device];
  for (std::size_t earlier = range.begin; earlier < device; ++earlier) {
    if (sensors[earlier].id == sensor.id)
      return sensor.id + (sensor.velocity ? " velocity" : " position");
  }
  return sensor.id;
}

template <const auto& table, std::size_t row, class Struct>
void add_channel(const Moment& moment, const world::RobotLayout& robot, const Struct& from,
                 Message& out) {
  constexpr const auto& channel = std::get<row>(table);
  const world::Range range = channel.devices(moment.layout, robot);
  constexpr bool is_joints = std::string_view(channel.recorded) == "joint_encoders";
  for (std::size_t device = range.begin; device < range.end(); ++device) {
    const auto id = is_joints ? id_of_sensor(moment.layout, range, device)
                              : id_in(moment.layout, channel.id, device);
    write(out, channel.recorded, id ? &*id : nullptr, (from.*channel.values)[device]);
  }
}

/// All channels that have a field of their own.
template <const auto& table, class Struct>
void add(const Moment& moment, const world::RobotLayout& robot, const Struct& from, Message& out) {
  world::for_each_channel(table, [&](auto i) {
    constexpr std::size_t row = i;
    if constexpr (std::get<row>(table).recorded != nullptr) {
      add_channel<table, row>(moment, robot, from, out);
    }
  });
}

// --- described devices --------------------------------------------------------------------------

using Values = google::protobuf::Map<std::string, double>;
using DeviceMap = google::protobuf::Map<std::string, v1::Devices>;

template <class Fields>
void set_values(const Fields& fields, const double* values, Values& out) {
  for (const auto& field : fields) out[field.name] = *values++;
}

void set_readings(const Moment& moment, const world::DescribedDevice& device, v1::Device& out) {
  const auto& readings = device.kind->readings;
  const world::Observations& seen = moment.observations;
  if (device.readings.count > 0) {
    set_values(readings, &seen.device_readings[device.readings.begin], *out.mutable_values());
  }
  if (device.rows.count == 0) return;
  const std::vector<double>& rows = seen.device_rows[device.rows.begin].values;
  for (std::size_t first = 0; first < rows.size(); first += readings.size()) {
    set_values(readings, &rows[first], *out.add_rows()->mutable_values());
  }
}

void set_commands(const Moment& moment, const world::DescribedDevice& device, v1::Device& out) {
  const std::vector<double>& commands = moment.commands.device_commands;
  set_values(device.kind->commands, &commands[device.commands.begin], *out.mutable_values());
}

/// Adds the robot's described devices for which `has` is true.
template <class Has, class Set>
void add_described(const Moment& moment, const world::RobotLayout& robot, DeviceMap& out, Has has,
                   Set set) {
  for (std::size_t i = robot.described.begin; i < robot.described.end(); ++i) {
    const world::DescribedDevice& device = moment.layout.described[i];
    if (!has(device)) continue;
    v1::Device& to = *out[device.kind->name].add_devices();
    to.set_id(v1::valid_utf8(device.id));
    set(moment, device, to);
  }
}

/// Adds a robot's readings and shown values of fixed size.
void add_channels(const Moment& moment, const world::RobotLayout& robot,
                  v1::RobotObservation& out) {
  add<world::sensed>(moment, robot, moment.observations, out);
  add_described(
      moment, robot, *out.mutable_devices(), [](const auto& device) { return device.measures(); },
      set_readings);
  world::for_each_channel(world::state_fields, [&](auto i) {
    constexpr auto& shown = std::get<i>(world::state_fields);
    if constexpr (shown.recorded != nullptr) {
      const world::Range range = moment.layout.entities[robot.entity].*shown.devices;
      for (std::size_t device = range.begin; device < range.end(); ++device) {
        write(out, shown.recorded, nullptr, (moment.state.*shown.values)[device]);
      }
    }
  });
}

/// Adds the values that it set.
void add_channels(const Moment& moment, const world::RobotLayout& robot, v1::RobotCommand& out) {
  add<world::commanded>(moment, robot, moment.commands, out);
  add_described(
      moment, robot, *out.mutable_devices(),
      [](const auto& device) { return device.commands.count > 0; }, set_commands);
}

/// Readings of a camera; they ascend by camera.
template <typename Reading>
std::span<const Reading> seen_by(std::size_t camera, const std::vector<Reading>& readings) {
  const auto first = std::ranges::lower_bound(readings, camera, {}, &Reading::camera);
  const auto last = std::ranges::upper_bound(readings, camera, {}, &Reading::camera);
  return {first, last};
}

void fill(const math::Vector2& from, v1::Pixel& to) {
  to.set_u(from.x());
  to.set_v(from.y());
}

void add_leds(std::span<const world::LedReading> seen,
              google::protobuf::RepeatedPtrField<v1::SeenLed>& out) {
  for (const world::LedReading& led : seen) {
    v1::SeenLed& to = *out.Add();
    *to.mutable_color() = color_of(led.color);
    fill(led.center, *to.mutable_center());
  }
}

/// Adds an entry for each camera of the robot, also for those that see nothing.
void add_cameras(const Moment& moment, const world::RobotLayout& robot, CameraMap& out) {
  for (std::size_t i = robot.cameras.begin; i < robot.cameras.end(); ++i) {
    v1::CameraReading& camera = out[v1::valid_utf8(moment.layout.cameras[i].id)];
    add_leds(seen_by(i, moment.observations.leds), *camera.mutable_leds());
    add_leds(seen_by(i, moment.observations.directional_leds), *camera.mutable_directional_leds());
    for (const world::TagReading& tag : seen_by(i, moment.observations.tags)) {
      v1::SeenTag& to = *camera.add_tags();
      to.set_payload(v1::valid_utf8(moment.state.tag_payloads[tag.tag]));
      fill(tag.center, *to.mutable_center());
      for (const math::Vector2& corner : tag.corners) fill(corner, *to.add_corners());
    }
  }
}

void add_bytes(std::span<const std::uint8_t> bytes,
               google::protobuf::RepeatedField<std::uint32_t>& out) {
  out.Add(bytes.begin(), bytes.end());
}

using MessageMap = google::protobuf::Map<std::string, v1::Messages>;

/// The messages of a robot's radios for which `uses` is true; entries are in any order of radios.
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

void fill_observation(const Moment& moment, const world::RobotLayout& robot,
                      v1::RobotObservation& out) {
  add_channels(moment, robot, out);
  add_messages(
      moment, robot.radios, moment.observations.radio_messages,
      [](const world::RadioLayout& radio) { return radio.receives; },
      *out.mutable_radio_messages());
  add_packets(moment, robot.range_and_bearing, out);
  add_cameras(moment, robot, *out.mutable_cameras());
}

void fill_command(const Moment& moment, const world::RobotLayout& robot, v1::RobotCommand& out) {
  add_channels(moment, robot, out);
  add_messages(
      moment, robot.radios, moment.commands.radio_messages,
      [](const world::RadioLayout& radio) { return radio.sends; }, *out.mutable_radio_messages());
}

}  // namespace

const world::RobotLayout& robot_with(std::size_t camera, const world::Layout& layout) {
  for (const world::RobotLayout& robot : layout.robots) {
    if (camera < robot.cameras.end()) return robot;
  }
  return layout.robots.back();
}

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

}  // namespace ziggurat::outputs
