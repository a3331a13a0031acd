// SPDX-License-Identifier: MIT
#pragma once
// Channels between the world and the fields of messages that carry them.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "wire/messages.h"
#include "wire/roster.h"
#include "world/commands.h"
#include "world/devices.h"
#include "world/layout.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {

/// The field of Observation that carries a channel.
template <class T>
struct ObservationField {
  std::vector<T> world::Observations::*values;
  google::protobuf::RepeatedField<double>* (v1::Observation::*packed)();
};
template <class T>
ObservationField(std::vector<T> world::Observations::*,
                 google::protobuf::RepeatedField<double>* (v1::Observation::*)())
    -> ObservationField<T>;

/// The field of Command that carries a channel: a repeated field, or a text of bytes.
template <class T, class Packed>
struct CommandField {
  std::vector<T> world::Commands::*values;
  const Packed& (v1::Command::*packed)() const;
  Packed* (v1::Command::*to_fill)();
};
template <class T, class Packed>
CommandField(std::vector<T> world::Commands::*, const Packed& (v1::Command::*)() const,
             Packed* (v1::Command::*)()) -> CommandField<T, Packed>;

/// The field that carries a channel. Does not compile if there is none.
template <const auto& fields, const auto& table, std::size_t row>
constexpr const auto& field_of() {
  constexpr std::size_t found = world::row_of(fields, std::get<row>(table).values);
  static_assert(found < std::tuple_size_v<std::decay_t<decltype(fields)>>,
                "a channel of the world has no field in a message; add it to the table of fields");
  return std::get<found>(fields);
}

// --- out ----------------------------------------------------------------------------------------

template <class T>
void add(const Packing& packing, const std::vector<T>& flat,
         google::protobuf::RepeatedField<double>& packed) {
  for (const Packing::Stretch& piece : packing.stretches) {
    const T* begin = flat.data() + piece.flat;
    if constexpr (std::is_same_v<T, double>) {
      packed.Add(begin, begin + piece.count);
    } else {
      for (std::size_t i = 0; i < piece.count; ++i) {
        const auto values = world::numbers(begin[i]);
        packed.Add(values.begin(), values.end());
      }
    }
  }
}

inline void add_value(double value, google::protobuf::RepeatedField<double>& packed) {
  packed.Add(value);
}
template <world::Numbers T>
void add_value(const T& value, google::protobuf::RepeatedField<double>& packed) {
  const auto values = world::numbers(value);
  packed.Add(values.begin(), values.end());
}
inline void add_value(world::Color value, google::protobuf::RepeatedField<std::uint32_t>& packed) {
  packed.Add(value);
}
inline void add_value(const std::string& value,
                      google::protobuf::RepeatedPtrField<std::string>& packed) {
  *packed.Add() = value;
}
inline void add_value(std::uint8_t value, std::string& packed) {
  packed += static_cast<char>(value);
}
inline void add_value(world::TurretMode value, google::protobuf::RepeatedField<int>& packed) {
  packed.Add(static_cast<int>(value) + v1::TURRET_PASSIVE);
}

/// All values of a channel of Commands.
template <class T, class Packed>
void add_all(const Packing& packing, const std::vector<T>& flat, Packed& packed) {
  for (const Packing::Stretch& piece : packing.stretches) {
    for (std::size_t i = 0; i < piece.count; ++i) add_value(flat[piece.flat + i], packed);
  }
}

// --- which devices a command is for -------------------------------------------------------------

/// Number of devices that the robots of a command have.
inline std::size_t device_count(const v1::Command& command, const Packing& packing) {
  std::size_t count = command.robots().empty() ? packing.count : 0;
  for (const std::uint32_t position : command.robots()) count += packing.robots[position].count;
  return count;
}

/// The robot of the world that the device at `index` < device_count() belongs to, and the place of
/// the device in the world's list.
inline std::pair<const world::RobotLayout*, std::size_t> owner(const v1::Command& command,
                                                               const Roster& roster,
                                                               const world::Layout& layout,
                                                               const Packing& packing,
                                                               std::size_t index) {
  if (command.robots().empty()) {
    const std::size_t position = packing.owner(index);
    const Packing::Stretch& robot = packing.robots[position];
    return {&layout.robots[roster.robots[position]], robot.flat + index - robot.packed};
  }
  for (const std::uint32_t position : command.robots()) {
    const Packing::Stretch& robot = packing.robots[position];
    if (index < robot.count) return {&layout.robots[roster.robots[position]], robot.flat + index};
    index -= robot.count;
  }
  return {};  // not reached: the length was checked
}

/// Calls visit(index, flat) for the devices of the command's robots, without robots that left: what
/// is at `index` in the command is for the device at `flat` in the world.
template <typename Visit>
void for_each_device(const v1::Command& command, const Roster& roster, const Packing& packing,
                     Visit visit) {
  std::size_t index = 0;
  const auto visit_robot = [&](std::size_t position) {
    const Packing::Stretch& robot = packing.robots[position];
    for (std::size_t i = 0; i < robot.count && !roster.gone[position]; ++i) {
      visit(index + i, robot.flat + i);
    }
    index += robot.count;
  };
  for (const std::uint32_t position : command.robots()) visit_robot(position);
  if (!command.robots().empty()) return;
  for (std::size_t position = 0; position < packing.robots.size(); ++position) {
    visit_robot(position);
  }
}

// --- in -----------------------------------------------------------------------------------------

/// The value of a device, at a place among all of a field.
inline double value_at(const google::protobuf::RepeatedField<double>& packed, std::size_t device,
                       double*) {
  return packed.Get(static_cast<int>(device));
}
inline world::Color value_at(const google::protobuf::RepeatedField<std::uint32_t>& packed,
                             std::size_t device, world::Color*) {
  return packed.Get(static_cast<int>(device));
}
inline const std::string& value_at(const google::protobuf::RepeatedPtrField<std::string>& packed,
                                   std::size_t device, std::string*) {
  return packed.Get(static_cast<int>(device));
}
inline std::uint8_t value_at(const std::string& packed, std::size_t device, std::uint8_t*) {
  return static_cast<std::uint8_t>(packed[device]);
}
/// An unknown number is a mode that the rule refuses.
inline world::TurretMode value_at(const google::protobuf::RepeatedField<int>& packed,
                                  std::size_t device, world::TurretMode*) {
  const int mode = packed.Get(static_cast<int>(device));
  const bool known = mode >= v1::TURRET_PASSIVE && mode <= v1::TURRET_SPEED;
  return static_cast<world::TurretMode>(known ? mode - v1::TURRET_PASSIVE : 255);
}
template <world::Numbers T>
T value_at(const google::protobuf::RepeatedField<double>& packed, std::size_t device, T*) {
  std::array<double, world::width<T>> values;
  std::copy_n(packed.begin() + static_cast<std::ptrdiff_t>(device * values.size()), values.size(),
              values.begin());
  return std::bit_cast<T>(values);
}

/// The same for people.
template <class Packed, class T>
std::string words_of(const Packed& packed, std::size_t device, const T& value) {
  if constexpr (std::is_same_v<T, std::string>) {
    return fmt::format("{} bytes", value.size());
  } else if constexpr (std::is_same_v<T, world::Color>) {
    return fmt::format("{:#x}", value);
  } else if constexpr (world::Numbers<T>) {
    return fmt::format("{}", fmt::join(world::numbers(value), ", "));
  } else {
    return fmt::format("{}", packed[static_cast<int>(device)]);  // as it was sent
  }
}

/// There are no values, or as many as the devices of the command's robots take.
template <class T, class Packed>
std::optional<Fault> check_count(const v1::Command& command, const Packing& packing,
                                 const world::Commanded<T>& channel, const Packed& packed) {
  const auto count = static_cast<std::size_t>(packed.size());
  if (count == 0) return std::nullopt;
  const std::size_t devices = device_count(command, packing);
  constexpr std::size_t each = world::width<T>;
  if (count == devices * each) return std::nullopt;
  return make_fault(ErrorCode::bad_value, channel.name,
                    fmt::format("The number of values is {}; it must be {} ({} {}{}), or 0.", count,
                                devices * each, devices, channel.device_words,
                                each == 1 ? "" : fmt::format(", {} values each", each)));
}

/// Each value follows the channel's rule; the first that does not is named.
template <class T, class Packed>
std::optional<Fault> check_values(const v1::Command& command, const Roster& roster,
                                  const world::Layout& layout, const Packing& packing,
                                  const world::Commanded<T>& channel, const Packed& packed) {
  if (!channel.rule.holds) return std::nullopt;
  const std::size_t devices = static_cast<std::size_t>(packed.size()) / world::width<T>;
  for (std::size_t i = 0; i < devices; ++i) {
    const auto& value = value_at(packed, i, static_cast<T*>(nullptr));
    if (channel.rule.holds(value)) continue;
    const auto [robot, device] = owner(command, roster, layout, packing, i);
    return make_fault(
        channel.rule.limits_size ? ErrorCode::too_large : ErrorCode::bad_value, channel.name,
        fmt::format("The {}{} of robot '{}' is {}; it must be {}.", channel.value_words,
                    channel.id ? fmt::format(" '{}'", channel.id(layout, device)) : "", robot->id,
                    words_of(packed, i, value), channel.rule.words),
        robot->id);
  }
  return std::nullopt;
}

template <class T, class Packed>
void apply(const v1::Command& command, const Roster& roster, const Packing& packing,
           const Packed& packed, std::vector<T>& flat) {
  if (packed.empty()) return;
  for_each_device(command, roster, packing, [&](std::size_t index, std::size_t place) {
    flat[place] = value_at(packed, index, static_cast<T*>(nullptr));
  });
}

}  // namespace ziggurat::wire
