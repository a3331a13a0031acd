#include "outputs/reading.h"

#include <algorithm>
#include <span>

#include "outputs/channels.h"
#include "outputs/reading_cameras.h"
#include "ziggurat/v1/envelope.h"

namespace ziggurat::outputs {

v1::Color color_of(world::Color packed) {
  v1::Color color;
  color.set_red(packed >> 16 & 0xFF);
  color.set_green(packed >> 8 & 0xFF);
  color.set_blue(packed & 0xFF);
  return color;
}

namespace {

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
