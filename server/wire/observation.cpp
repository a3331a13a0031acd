// SPDX-License-Identifier: MIT
#include "wire/observation.h"

#include <algorithm>
#include <cstddef>
#include <span>

#include "wire/devices.h"

namespace ziggurat::wire {
namespace {

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

/// Calls visit(rows) for each device of the session that reads rows.
template <typename Visit>
void for_each_list(const Roster& roster, const world::Observations& from, Visit visit) {
  for (const Packing::Stretch& piece : roster.device_lists.stretches) {
    for (std::size_t i = 0; i < piece.count; ++i) visit(from.device_rows[piece.flat + i]);
  }
}

void add_rows(const Roster& roster, const world::Observations& from, v1::Observation& to) {
  for_each_list(roster, from, [&](const world::DeviceRows& rows) {
    to.add_device_rows(static_cast<std::uint32_t>(rows.count()));
    to.mutable_device_row_values()->Add(rows.values.begin(), rows.values.end());
  });
}

}  // namespace

ReadingSize size_of_readings(const Roster& roster, const world::Observations& from,
                             std::span<const std::string> tag_payloads) {
  constexpr std::size_t size_of_message = 32, size_of_packet = 64;
  ReadingSize size;
  for_each(
      roster.radios, from.radio_messages.entries, [](const auto& entry) { return entry.radio; },
      [&](const world::RadioMessages::Entry& entry, std::size_t) {
        size.size += size_of_message;
        size.add_payload(entry.size);
      });
  for_each(
      roster.range_and_bearing, from.range_and_bearing,
      [](const auto& packet) { return packet.receiver; },
      [&](const world::RangeAndBearingPacket& packet, std::size_t) {
        size.size += size_of_packet + packet.data.count;
      });
  for_each_list(roster, from, [&](const world::DeviceRows& rows) {
    size.size += rows.values.size() * sizeof(double);
  });
  count_cameras(roster, from, tag_payloads, size);
  return size;
}

void fill(const Roster& roster, const world::Observations& from,
          std::span<const std::string> tag_payloads, v1::Observation& to) {
  to.set_tick(from.tick);
  to.set_time_ns(from.time_ns);
  add_channels(roster, from, to);
  add_radio_messages(roster, from.radio_messages, to);
  add_packets(roster, from, to);
  add_rows(roster, from, to);
  add_cameras(roster, from, tag_payloads, to);
}

}  // namespace ziggurat::wire
