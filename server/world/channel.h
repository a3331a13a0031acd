// SPDX-License-Identifier: MIT
#pragma once
// A channel is a field of Observations, Commands or State with the same number of values for each
// device of a kind. A table beside each of those structs lists all of its fields, each once: as a
// channel, or as handled by hand. What is the same for all channels iterates over the tables.

#include <array>
#include <bit>
#include <cstddef>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "math/pose.h"

namespace ziggurat::world {

/// A run of elements in a flat array.
struct Range {
  std::size_t begin = 0;
  std::size_t count = 0;
  std::size_t end() const { return begin + count; }
};

struct DeviceLists;
struct DeviceRanges;
struct Observations;
struct Commands;
struct State;
struct EntityLayout;

/// Range of a robot's values in the array of a channel.
using DevicesOf = Range (*)(const DeviceLists&, const DeviceRanges&);
/// Id of the device at a place of that array.
using IdOf = const std::string& (*)(const DeviceLists&, std::size_t);

/// All devices of a kind that a robot has.
template <Range DeviceRanges::*range>
Range all(const DeviceLists&, const DeviceRanges& robot) {
  return robot.*range;
}

/// The one device of a kind that a robot has, if its controller uses it so.
template <Range DeviceRanges::*range, auto list, auto used>
Range one_if(const DeviceLists& lists, const DeviceRanges& robot) {
  const Range& found = robot.*range;
  return {found.begin, found.count > 0 && (lists.*list)[found.begin].*used ? found.count : 0};
}

template <auto list>
const std::string& id(const DeviceLists& lists, std::size_t device) {
  return (lists.*list)[device].id;
}

using Ranges = DeviceRanges;
using Lists = DeviceLists;

/// When a field enters the hash, in the order of its table. New fields come last in the tables, so
/// that the hashes of scenes without them stay.
enum class Hashed { no, first, second };

/// A field that is not a channel.
template <class Owner, class T>
struct ByHand {
  T Owner::*values;
  Hashed hashed;
};
template <class Owner, class T>
ByHand(T Owner::*, Hashed) -> ByHand<Owner, T>;

/// Channel of a robot's readings.
template <class T>
struct Sensed {
  std::vector<T> Observations::*values;
  const char* recorded;  ///< field of RobotObservation in recording.proto; null: by description
  DevicesOf devices;
  IdOf id = nullptr;  ///< null: recorded by position
  Hashed hashed = Hashed::second;
};

/// Channel of an entity's visible state.
template <class T>
struct Shown {
  std::vector<T> State::*values;
  const char* recorded = nullptr;          ///< as above; null: not recorded
  Range EntityLayout::*devices = nullptr;  ///< if it is recorded
  Hashed hashed = Hashed::second;
};

/// Which values of a channel a robot may set.
template <class T>
struct Rule {
  bool (*holds)(const T&);  ///< null: any value is valid
  const char* words;        ///< "it must be …"
  bool limits_size = false;
};

/// Treatment of a channel's values when their robot leaves.
enum class Released {
  kept,
  zeroed,
  described,  ///< each gets DeviceCommand::released
};

/// Channel of a robot's commands.
template <class T>
struct Commanded {
  std::vector<T> Commands::*values;
  const char* name;          ///< field of Command in protocol.proto
  const char* recorded;      ///< of RobotCommand in recording.proto; "a.b": field b of message a;
                             ///< null: by description
  const char* value_words;   ///< "target of joint"
  const char* device_words;  ///< "joint actuators"
  DevicesOf devices;
  IdOf id;  ///< null: recorded by position
  Rule<T> rule;
  Released released;
};

template <class Row>
inline constexpr bool is_by_hand = false;
template <class Owner, class T>
inline constexpr bool is_by_hand<ByHand<Owner, T>> = true;

/// Calls visit(std::integral_constant<std::size_t, I>) for each row of a table.
template <class Table, class Visit>
constexpr void for_each_row(const Table&, Visit visit) {
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    (visit(std::integral_constant<std::size_t, i>()), ...);
  }
  (std::make_index_sequence<std::tuple_size_v<Table>>());
}

/// The same for the channels among the rows.
template <class Table, class Visit>
constexpr void for_each_channel(const Table& table, Visit visit) {
  for_each_row(table, [&](auto i) {
    if constexpr (!is_by_hand<std::tuple_element_t<i, Table>>) visit(i);
  });
}

/// The row of a field, the last one if it has several; the size of the table if it has none.
template <class Table, class Field>
constexpr std::size_t row_of(const Table& table, Field field) {
  std::size_t found = std::tuple_size_v<Table>;
  for_each_row(table, [&](auto i) {
    if constexpr (std::is_same_v<decltype(std::get<i>(table).values), Field>) {
      if (std::get<i>(table).values == field) found = i;
    }
  });
  return found;
}

/// Stands for a value of any type; never evaluated.
struct AnyValue {
  template <class T>
  operator T() const;
};

/// Number of fields of a struct without base class: of how many values it can be made.
template <class Struct, class... Values>
consteval std::size_t field_count() {
  if constexpr (requires { Struct{Values{}..., AnyValue{}}; }) {
    return field_count<Struct, Values..., AnyValue>();
  } else {
    return sizeof...(Values);
  }
}

/// Whether each field of a struct is in exactly one row of its table.
template <class Struct, class Table>
consteval bool lists_all_fields(const Table& table) {
  bool once = field_count<Struct>() == std::tuple_size_v<Table>;
  for_each_row(table,
               [&](auto i) { once = once && row_of(table, std::get<i>(table).values) == i; });
  return once;
}

/// A value that consists of `double` only: those of wheels, for example.
template <class T>
concept Numbers = std::is_trivially_copyable_v<T> && std::is_class_v<T> &&
                      alignof(T) == alignof(double) &&
                  sizeof(T) % sizeof(double) == 0;

/// The numbers of a value, in the order in which messages and recordings have them.
inline std::array<double, 7> numbers(const math::Pose& pose) {
  const math::Vector3& at = pose.position;
  const math::Quaternion& turned = pose.orientation;
  return {at.x(), at.y(), at.z(), turned.w(), turned.x(), turned.y(), turned.z()};
}
template <Numbers T>
std::array<double, sizeof(T) / sizeof(double)> numbers(const T& value) {
  return std::bit_cast<std::array<double, sizeof(T) / sizeof(double)>>(value);
}

/// Number of message values per value: one unless it is several numbers.
template <class T>
inline constexpr std::size_t width = 1;
template <Numbers T>
inline constexpr std::size_t width<T> = sizeof(T) / sizeof(double);
template <>
inline constexpr std::size_t width<math::Pose> = 7;

}  // namespace ziggurat::world
