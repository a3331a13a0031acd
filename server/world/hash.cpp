// SPDX-License-Identifier: MIT
// The fields of State and Observations in the order of their tables: those that are hashed first,
// then the others.

#include "math/hash.h"

#include <span>
#include <string_view>

#include "world/state.h"

namespace ziggurat::world {
namespace {

/// Adds one value or field after the other.
struct Hasher {
  const State& state;
  const Observations& observations;
  math::Hash hash = {};

  void add(double value) { hash.add(value); }
  void add(std::uint64_t number) { hash.add(number); }
  void add(Color color) { hash.add(std::uint64_t{color}); }
  void add(const std::string& text) { hash.add(std::string_view(text)); }
  void add(std::span<const std::uint8_t> bytes) {
    hash.add(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  }
  void add(const std::vector<std::uint8_t>& bytes) { add(std::span(bytes)); }
  void add(const std::vector<double>& values) { hash.add(values); }
  void add(const math::Vector2& vector) { hash.add(std::span(vector.data(), 2)); }
  void add(const math::Vector3& vector) { hash.add(std::span(vector.data(), 3)); }
  void add(const math::Pose& pose) {
    add(pose.position);
    hash.add(std::span(pose.orientation.coeffs().data(), 4));
  }
  template <Numbers T>
  void add(const T& value) {
    hash.add(numbers(value));
  }
  void add(const LinkState& link) {
    add(link.pose);
    add(link.velocity);
    add(link.angular_velocity);
  }
  /// As many as there are devices, or links, or entities: their number need not be added.
  template <class T>
  void add(const std::vector<T>& values) {
    for (const T& value : values) add(value);
  }

  void add(const std::vector<bool>& absent) {
    for (std::size_t i = 0; i < absent.size(); ++i) {
      if (absent[i]) add(std::uint64_t{i});
    }
  }

  // Fields of which there may be any number of values.
  void add(const RadioMessages& messages) {
    add(std::uint64_t{messages.entries.size()});
    for (const RadioMessages::Entry& entry : messages.entries) {
      add(std::uint64_t{entry.radio});
      add(messages.payload(entry));
    }
  }
  /// Nothing of a floor that was not painted.
  void add(const std::vector<FloorPaint>& floor) {
    for (const FloorPaint& region : floor) {
      hash.add(std::span(region.center));
      hash.add(std::span(region.half_size));
      add(std::uint64_t{region.is_disc});
      add(region.color);
      if (region.image) add(region.image->digest);
    }
  }
  void add(const std::vector<RangeAndBearingPacket>& packets) {
    const std::span data(observations.range_and_bearing_data);
    add(std::uint64_t{packets.size()});
    for (const RangeAndBearingPacket& packet : packets) {
      add(std::uint64_t{packet.receiver});
      add(packet.range);
      add(packet.horizontal_bearing);
      add(packet.vertical_bearing);
      add(data.subspan(packet.data.begin, packet.data.count));
    }
  }
  void add(const std::vector<DeviceRows>& lists) {
    for (const DeviceRows& rows : lists) {
      add(std::uint64_t{rows.count()});
      add(rows.values);
    }
  }
  void add(const std::vector<LedReading>& readings) {
    add(std::uint64_t{readings.size()});
    for (const LedReading& reading : readings) {
      add(std::uint64_t{reading.camera});
      add(reading.color);
      add(reading.center);
    }
  }
  void add(const std::vector<TagReading>& readings) {
    add(std::uint64_t{readings.size()});
    for (const TagReading& reading : readings) {
      add(std::uint64_t{reading.camera});
      add(state.tag_payloads[reading.tag]);
      add(reading.center);
      for (const math::Vector2& corner : reading.corners) add(corner);
    }
  }

  /// The fields of a table that are hashed at a stage.
  template <Hashed stage, const auto& table, class Struct>
  void add_fields(const Struct& fields) {
    for_each_row(table, [&](auto i) {
      constexpr auto& row = std::get<i>(table);
      if constexpr (row.hashed == stage) add(fields.*row.values);
    });
  }
};

}  // namespace

std::uint64_t hash(const State& state, const Observations& observations) {
  Hasher hasher{state, observations};
  hasher.add_fields<Hashed::first, state_fields>(state);
  hasher.add_fields<Hashed::first, sensed>(observations);
  hasher.add_fields<Hashed::second, state_fields>(state);
  hasher.add_fields<Hashed::second, sensed>(observations);
  return hasher.hash.digest();
}

}  // namespace ziggurat::world
