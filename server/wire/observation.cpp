#include "wire/observation.h"

#include <algorithm>
#include <cstddef>
#include <span>

#include "wire/observation_cameras.h"

namespace ziggurat::wire {
namespace {

void add(const Packing& packing, const std::vector<double>& flat,
         google::protobuf::RepeatedField<double>& packed) {
  for (const Packing::Stretch& piece : packing.stretches) {
    const double* begin = flat.data() + piece.flat;
    packed.Add(begin, begin + piece.count);
  }
}

void assign(std::string& to, std::span<const std::uint8_t> from) {
  to.assign(reinterpret_cast<const char*>(from.data()), from.size());
}

/// Calls visit(entry, position) for each entry of a list that ascends by the place of its
/// receiver, if that belongs to the session; `position` is the receiver's in the packing.
template <typename Entry, typename Receiver, typename Visit>
void for_each(const Packing& packing, const std::vector<Entry>& entries, Receiver receiver,
              Visit visit) {
  auto entry = entries.begin();
  for (const Packing::Stretch& piece : packing.stretches) {
    entry = std::lower_bound(
        entry, entries.end(), piece.flat,
        [&](const Entry& candidate, std::size_t flat) { return receiver(candidate) < flat; });
    for (; entry != entries.end() && receiver(*entry) < piece.flat + piece.count; ++entry) {
      visit(*entry, receiver(*entry) - piece.flat + piece.packed);
    }
  }
}

void add_radio_messages(const Roster& roster, const world::RadioMessages& from,
                        v1::Observation& to) {
  for_each(
      roster.radios, from.entries, [](const auto& entry) { return entry.radio; },
      [&](const world::RadioMessages::Entry& entry, std::size_t radio) {
        v1::RadioMessage& message = *to.add_radio_messages();
        message.set_radio(static_cast<std::uint32_t>(radio));
        assign(*message.mutable_payload(), from.payload(entry));
      });
}

void add_packets(const Roster& roster, const world::Observations& from, v1::Observation& to) {
  const Packing& devices = roster.range_and_bearing;
  const std::span all(from.range_and_bearing_data);
  for_each(
      devices, from.range_and_bearing, [](const auto& packet) { return packet.receiver; },
      [&](const world::RangeAndBearingPacket& heard, std::size_t device) {
        v1::RangeAndBearingPacket& packet = *to.add_range_and_bearing();
        packet.set_robot(static_cast<std::uint32_t>(devices.owner(device)));
        packet.set_range(heard.range);
        packet.set_horizontal_bearing(heard.horizontal_bearing);
        packet.set_vertical_bearing(heard.vertical_bearing);
        assign(*packet.mutable_data(), all.subspan(heard.data.begin, heard.data.count));
      });
}

void add_poses(const Packing& packing, const std::vector<math::Pose>& flat,
               google::protobuf::RepeatedField<double>& packed) {
  for (const Packing::Stretch& piece : packing.stretches) {
    for (std::size_t i = piece.flat; i < piece.flat + piece.count; ++i) {
      const math::Vector3& at = flat[i].position;
      const math::Quaternion& turned = flat[i].orientation;
      for (const double value :
           {at.x(), at.y(), at.z(), turned.w(), turned.x(), turned.y(), turned.z()}) {
        packed.Add(value);
      }
    }
  }
}

void add_wheels(const Packing& packing, const std::vector<world::WheelsReading>& flat,
                google::protobuf::RepeatedField<double>& packed) {
  for (const Packing::Stretch& piece : packing.stretches) {
    for (std::size_t i = piece.flat; i < piece.flat + piece.count; ++i) {
      packed.Add(flat[i].velocity_left);
      packed.Add(flat[i].velocity_right);
      packed.Add(flat[i].distance_left);
      packed.Add(flat[i].distance_right);
    }
  }
}

}  // namespace

std::size_t radio_bytes(const Roster& roster, const world::RadioMessages& messages) {
  std::size_t bytes = 0;
  for_each(
      roster.radios, messages.entries, [](const auto& entry) { return entry.radio; },
      [&](const world::RadioMessages::Entry& entry, std::size_t) { bytes += entry.size; });
  return bytes;
}

void fill(const Roster& roster, const world::Observations& from,
          std::span<const std::string> tag_payloads, v1::Observation& to) {
  to.set_tick(from.tick);
  to.set_time_ns(from.time_ns);
  add(roster.joint_sensors, from.joint_readings, *to.mutable_joint_readings());
  add_radio_messages(roster, from.radio_messages, to);
  add(roster.proximity, from.proximity, *to.mutable_proximity());
  add_packets(roster, from, to);
  add_poses(roster.positioning, from.positioning, *to.mutable_positioning());
  for (const Packing::Stretch& piece : roster.batteries.stretches) {
    for (std::size_t i = piece.flat; i < piece.flat + piece.count; ++i) {
      to.add_batteries(from.batteries[i].available_charge);
      to.add_batteries(from.batteries[i].time_left);
    }
  }
  add_cameras(roster, from, tag_payloads, to);
  add_wheels(roster.wheel_sensors, from.wheels, *to.mutable_wheels());
  add(roster.turret_encoders, from.turrets, *to.mutable_turret_rotations());
}

}  // namespace ziggurat::wire
