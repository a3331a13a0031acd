#include <span>
#include <string_view>

#include "world/state.h"

namespace ziggurat::world {
namespace {

void add(math::Hash& hash, const math::Pose& pose) {
  hash.add(std::span(pose.position.data(), 3));
  hash.add(std::span(pose.orientation.coeffs().data(), 4));
}

void add(math::Hash& hash, const std::vector<Color>& colors) {
  for (const Color color : colors) hash.add(std::uint64_t{color});
}

void add(math::Hash& hash, std::span<const std::uint8_t> bytes) {
  hash.add(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

void add_visible(math::Hash& hash, const State& state) {
  add(hash, state.led_colors);
  add(hash, state.directional_led_colors);
  for (const std::string& payload : state.tag_payloads) hash.add(std::string_view(payload));
  for (const math::Vector3& field : state.magnet_fields) hash.add(std::span(field.data(), 3));
  add(hash, state.range_and_bearing_data);
}

void add_sensed(math::Hash& hash, const Observations& observations) {
  hash.add(std::uint64_t{observations.radio_messages.entries.size()});
  for (const RadioMessages::Entry& entry : observations.radio_messages.entries) {
    hash.add(std::uint64_t{entry.radio});
    add(hash, observations.radio_messages.payload(entry));
  }
  hash.add(observations.proximity);
  hash.add(std::uint64_t{observations.range_and_bearing.size()});
  for (const RangeAndBearingPacket& packet : observations.range_and_bearing) {
    hash.add(std::uint64_t{packet.receiver});
    hash.add(packet.range);
    hash.add(packet.horizontal_bearing);
    hash.add(packet.vertical_bearing);
    add(hash, std::span(observations.range_and_bearing_data)
                  .subspan(packet.data.begin, packet.data.count));
  }
  for (const math::Pose& pose : observations.positioning) add(hash, pose);
  for (const BatteryReading& battery : observations.batteries) {
    hash.add(battery.available_charge);
    hash.add(battery.time_left);
  }
  for (const WheelsReading& wheels : observations.wheels) {
    hash.add(wheels.velocity_left);
    hash.add(wheels.velocity_right);
    hash.add(wheels.distance_left);
    hash.add(wheels.distance_right);
  }
  hash.add(observations.turrets);
}

void add(math::Hash& hash, const std::vector<LedReading>& readings) {
  hash.add(std::uint64_t{readings.size()});
  for (const LedReading& reading : readings) {
    hash.add(std::uint64_t{reading.camera});
    hash.add(std::uint64_t{reading.color});
    hash.add(std::span(reading.center.data(), 2));
  }
}

void add_detected(math::Hash& hash, const State& state, const Observations& observations) {
  add(hash, observations.leds);
  add(hash, observations.directional_leds);
  hash.add(std::uint64_t{observations.tags.size()});
  for (const TagReading& reading : observations.tags) {
    hash.add(std::uint64_t{reading.camera});
    hash.add(std::string_view(state.tag_payloads[reading.tag]));
    hash.add(std::span(reading.center.data(), 2));
    for (const math::Vector2& corner : reading.corners) hash.add(std::span(corner.data(), 2));
  }
}

}  // namespace

std::uint64_t hash(const State& state, const Observations& observations) {
  math::Hash hash;
  hash.add(state.tick);
  for (const auto& origin : state.origins) add(hash, origin);
  for (const auto& link : state.links) {
    add(hash, link.pose);
    hash.add(std::span(link.velocity.data(), 3));
    hash.add(std::span(link.angular_velocity.data(), 3));
  }
  for (std::size_t i = 0; i < state.absent.size(); ++i) {
    if (state.absent[i]) hash.add(std::uint64_t{i});
  }
  hash.add(observations.joint_readings);
  add_visible(hash, state);
  add_sensed(hash, observations);
  add_detected(hash, state, observations);
  return hash.digest();
}

}  // namespace ziggurat::world
