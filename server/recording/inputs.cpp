// SPDX-License-Identifier: MIT
#include "recording/inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <tuple>
#include <type_traits>

#include "world/limits.h"
#include "ziggurat/v1/run.pb.h"

namespace ziggurat::recording {
namespace {

/// The array of a message that has the values of a channel.
template <class T, class Array>
struct Packed {
  std::vector<T> world::Commands::*values;
  bool (v1::Commands::*has)() const;
  const Array& (v1::Commands::*get)() const;
  Array* (v1::Commands::*add)();
};

using v1::Commands;
using Numbers = v1::Commands::Numbers;
using Integers = v1::Commands::Integers;
using Payloads = v1::Commands::Payloads;

constexpr std::tuple packed{
    Packed<double, Numbers>{&world::Commands::joint_targets, &Commands::has_joint_targets,
                            &Commands::joint_targets, &Commands::mutable_joint_targets},
    Packed<world::Color, Integers>{&world::Commands::led_colors, &Commands::has_led_colors,
                                   &Commands::led_colors, &Commands::mutable_led_colors},
    Packed<world::Color, Integers>{
        &world::Commands::directional_led_colors, &Commands::has_directional_led_colors,
        &Commands::directional_led_colors, &Commands::mutable_directional_led_colors},
    Packed<std::string, Payloads>{&world::Commands::tag_payloads, &Commands::has_tag_payloads,
                                  &Commands::tag_payloads, &Commands::mutable_tag_payloads},
    Packed<double, Numbers>{&world::Commands::magnet_currents, &Commands::has_magnet_currents,
                            &Commands::magnet_currents, &Commands::mutable_magnet_currents},
    Packed<std::uint8_t, std::string>{
        &world::Commands::range_and_bearing_data, &Commands::has_range_and_bearing_data,
        &Commands::range_and_bearing_data, &Commands::mutable_range_and_bearing_data},
    Packed<world::WheelsCommand, Numbers>{&world::Commands::wheels, &Commands::has_wheels,
                                          &Commands::wheels, &Commands::mutable_wheels},
    Packed<world::TurretMode, Integers>{&world::Commands::turret_modes, &Commands::has_turret_modes,
                                        &Commands::turret_modes, &Commands::mutable_turret_modes},
    Packed<double, Numbers>{&world::Commands::turret_rotations, &Commands::has_turret_rotations,
                            &Commands::turret_rotations, &Commands::mutable_turret_rotations},
    Packed<double, Numbers>{&world::Commands::turret_speeds, &Commands::has_turret_speeds,
                            &Commands::turret_speeds, &Commands::mutable_turret_speeds},
    Packed<double, Numbers>{&world::Commands::device_commands, &Commands::has_device_commands,
                            &Commands::device_commands, &Commands::mutable_device_commands},
};

/// Whether each channel of world::commanded is in one row.
consteval bool packs_all() {
  bool all = true;
  world::for_each_channel(world::commanded, [&](auto i) {
    all = all && world::row_of(packed, std::get<i>(world::commanded).values) <
                     std::tuple_size_v<decltype(packed)>;
  });
  return all;
}
static_assert(packs_all(), "list each channel of world::commanded in the table `packed`");

/// The array of a channel in words.
template <class Channel>
constexpr const char* array_name(const Channel& channel) {
  return channel.recorded ? channel.recorded : channel.name;
}

/// Equal bits: 0.0 and -0.0 differ.
template <class T>
bool is_same(const std::vector<T>& a, const std::vector<T>& b) {
  if constexpr (std::is_same_v<T, std::string>) {
    return a == b;
  } else {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
  }
}

template <class T>
void write(const std::vector<T>& values, Numbers& to) {
  to.mutable_values()->Reserve(static_cast<int>(values.size() * world::width<T>));
  for (const T& value : values) {
    if constexpr (world::width<T> == 1) {
      to.add_values(value);
    } else {
      for (const double number : world::numbers(value)) to.add_values(number);
    }
  }
}
template <class T>
void write(const std::vector<T>& values, Integers& to) {
  for (const T& value : values) to.add_values(static_cast<std::uint32_t>(value));
}
void write(const std::vector<std::string>& values, Payloads& to) {
  for (const std::string& value : values) to.add_values(value);
}
void write(const std::vector<std::uint8_t>& values, std::string& to) {
  to.assign(values.begin(), values.end());
}

// False: some value does not fit into the type, or there is half a value.
template <class T>
bool read(const Numbers& from, std::vector<T>& to) {
  const auto count = static_cast<std::size_t>(from.values_size());
  if (count % world::width<T> != 0) return false;
  to.resize(count / world::width<T>);
  static_assert(sizeof(T) == world::width<T> * sizeof(double) && std::is_trivially_copyable_v<T>);
  void* const target = to.data();
  if (count > 0) std::memcpy(target, from.values().data(), count * sizeof(double));
  return true;
}
bool read(const Integers& from, std::vector<world::Color>& to) {
  to.assign(from.values().begin(), from.values().end());
  return true;
}
bool read(const Integers& from, std::vector<world::TurretMode>& to) {
  to.clear();
  for (const std::uint32_t value : from.values()) {
    if (value > std::numeric_limits<std::uint8_t>::max()) return false;
    to.push_back(static_cast<world::TurretMode>(value));
  }
  return true;
}
bool read(const Payloads& from, std::vector<std::string>& to) {
  to.assign(from.values().begin(), from.values().end());
  return true;
}
bool read(const std::string& from, std::vector<std::uint8_t>& to) {
  to.assign(from.begin(), from.end());
  return true;
}

/// Reads a message's values of a channel. @return  their fault, if they have one
template <std::size_t i>
std::optional<std::string> read_channel(const Commands& from, world::Commands& to) {
  constexpr auto& row = std::get<i>(packed);
  constexpr auto& channel = std::get<world::row_of(world::commanded, row.values)>(world::commanded);
  auto& values = to.*row.values;
  if ((from.*row.has)() && !read((from.*row.get)(), values)) {
    return fmt::format("the array {} has a value that is out of range or half a value",
                       array_name(channel));
  }
  if (!(from.*row.has)()) return std::nullopt;
  constexpr auto holds = channel.rule.holds;  // null: all values are right
  if constexpr (holds != nullptr) {
    for (std::size_t d = 0; d < values.size(); ++d) {
      if (holds(values[d])) continue;
      return fmt::format("the {} number {} must be {}", channel.value_words, d, channel.rule.words);
    }
  }
  return std::nullopt;
}

std::optional<std::string> read_radio_messages(const Commands& from, const world::Layout& layout,
                                               const world::State& state,
                                               world::RadioMessages& to) {
  to.clear();
  std::vector<std::size_t> counts(layout.radios.size()), bytes(layout.radios.size());
  for (const auto& message : from.radio_messages()) {
    const std::size_t radio = message.radio();
    if (radio >= layout.radios.size()) return fmt::format("there is no radio number {}", radio);
    const world::RadioLayout& device = layout.radios[radio];
    if (!device.sends || state.is_absent(device.mount.entity)) {
      return fmt::format("the radio '{}', number {}, can't send", device.id, radio);
    }
    const std::string& payload = message.payload();
    if (payload.size() > world::most_radio_message_bytes) {
      return fmt::format("a radio message has {} bytes; at most {} are allowed", payload.size(),
                         world::most_radio_message_bytes);
    }
    ++counts[radio];
    bytes[radio] += payload.size();
    to.add(radio, {reinterpret_cast<const std::uint8_t*>(payload.data()), payload.size()});
  }
  for (const world::RobotLayout& robot : layout.robots) {
    std::size_t count = 0, size = 0;
    for (std::size_t r = robot.radios.begin; r < robot.radios.end(); ++r) {
      count += counts[r];
      size += bytes[r];
    }
    if (count > world::most_radio_messages_per_robot || size > world::most_radio_bytes_per_robot) {
      return fmt::format(
          "the robot '{}' sends {} radio messages of {} bytes in one tick; at most "
          "{} of {} are allowed",
          robot.id, count, size, world::most_radio_messages_per_robot,
          world::most_radio_bytes_per_robot);
    }
  }
  return std::nullopt;
}

std::optional<std::string> read_pushes(const Commands& from, const world::Layout& layout,
                                       const world::State& state, std::vector<world::Push>& to) {
  to.clear();
  for (const auto& push : from.pushes()) {
    if (push.link() >= layout.links.size() || state.is_absent(layout.links[push.link()].entity)) {
      return fmt::format("there is no link number {} to push", push.link());
    }
    const auto& v = push.values();
    const auto is_bounded = [](double value) { return std::abs(value) <= world::largest_push; };
    if (v.size() != 6 || !std::ranges::all_of(v, is_bounded)) {
      return fmt::format("the push on link number {} must have six values from -1e6 to 1e6",
                         push.link());
    }
    to.push_back({push.link(), {v[0], v[1], v[2]}, {v[3], v[4], v[5]}});
  }
  return std::nullopt;
}

std::optional<std::string> read_floor_paints(const Commands& from,
                                             std::vector<world::FloorPaint>& to) {
  to.clear();
  for (const auto& paint : from.floor_paints()) {
    const auto& v = paint.values();
    world::FloorPaint region{.is_disc = paint.is_disc(), .color = paint.color()};
    if (v.size() == 4) {
      region.center = {v[0], v[1]};
      region.half_size = {v[2], v[3]};
    }
    if (!paint.image().empty()) {
      auto image = world::floor_image(paint.image());
      if (const auto* why = std::get_if<std::string>(&image))
        return "an image of the floor " + *why;
      region.image = std::get<0>(std::move(image));
    }
    if (!is_valid(region))
      return "a painted region of the floor has no valid place, size or colour";
    to.push_back(region);
  }
  return std::nullopt;
}

std::optional<std::string> read_markers(const Commands& from, const world::Layout& layout,
                                        std::vector<world::Marker>& to) {
  to.clear();
  std::vector<std::size_t> counts(from.markers().empty() ? 0 : layout.robots.size());
  for (const auto& read : from.markers()) {
    const auto& v = read.values();
    if (read.robot() >= layout.robots.size() || !layout.robots[read.robot()].draws_markers) {
      return fmt::format("the robot number {} can't draw", read.robot());
    }
    world::Marker marker{.robot = read.robot(), .color = read.color(), .text = read.text()};
    marker.shape = static_cast<world::Marker::Shape>(std::min(read.shape(), 2U));
    if (v.size() == 7) {
      marker.at = {v[0], v[1], v[2]};
      marker.to = {v[3], v[4], v[5]};
      marker.radius = v[6];
    }
    const std::size_t count = ++counts[read.robot()];
    if (v.size() != 7 || !is_valid(marker) || count > world::most_markers_per_robot) {
      return "a marker has no valid place, size, text or color, or there are too many";
    }
    to.push_back(std::move(marker));
  }
  return std::nullopt;
}

// --- states -------------------------------------------------------------------------------------

constexpr std::size_t link_width = 13;
using LinkValues = std::array<double, link_width>;

LinkValues values_of(const world::LinkState& link) {
  LinkValues values{};
  const auto pose = world::numbers(link.pose);
  std::copy(pose.begin(), pose.end(), values.begin());
  std::copy_n(link.velocity.data(), 3, values.begin() + 7);
  std::copy_n(link.angular_velocity.data(), 3, values.begin() + 10);
  return values;
}

world::LinkState link_of(const double* v) {
  world::LinkState link;
  link.pose.position = {v[0], v[1], v[2]};
  link.pose.orientation = math::Quaternion(v[3], v[4], v[5], v[6]);
  link.velocity = {v[7], v[8], v[9]};
  link.angular_velocity = {v[10], v[11], v[12]};
  return link;
}

bool is_same(const LinkValues& a, const LinkValues& b) {
  return std::memcmp(a.data(), b.data(), sizeof a) == 0;
}

}  // namespace

void CommandPacker::pack(const world::Commands& commands, v1::Commands& to) {
  world::for_each_row(packed, [&](auto i) {
    constexpr auto& row = std::get<i>(packed);
    const auto& values = commands.*row.values;
    if (!is_first_ && is_same(values, last_.*row.values)) return;
    last_.*row.values = values;
    write(values, *(to.*row.add)());
  });
  for (const auto& entry : commands.radio_messages.entries) {
    auto& message = *to.add_radio_messages();
    message.set_radio(static_cast<std::uint32_t>(entry.radio));
    const auto payload = commands.radio_messages.payload(entry);
    message.set_payload(payload.data(), payload.size());
  }
  for (const world::Push& push : commands.pushes) {
    auto& written = *to.add_pushes();
    written.set_link(static_cast<std::uint32_t>(push.link));
    for (const double value : push.force) written.add_values(value);
    for (const double value : push.torque) written.add_values(value);
  }
  for (const world::FloorPaint& region : commands.floor_paints) {
    auto& written = *to.add_floor_paints();
    written.set_is_disc(region.is_disc);
    written.set_color(region.color);
    if (region.image) written.set_image(region.image->file);
    for (const double value : region.center) written.add_values(value);
    for (const double value : region.half_size) written.add_values(value);
  }
  for (const world::Marker& marker : commands.markers) {
    auto& written = *to.add_markers();
    written.set_robot(static_cast<std::uint32_t>(marker.robot));
    written.set_shape(static_cast<std::uint32_t>(marker.shape));
    for (const double value : marker.at) written.add_values(value);
    for (const double value : marker.to) written.add_values(value);
    written.add_values(marker.radius);
    written.set_color(marker.color);
    written.set_text(marker.text);
  }
  is_first_ = false;
}

std::optional<std::string> unpack(const v1::Commands& from, const world::Layout& layout,
                                  const world::State& state, const world::Commands& like,
                                  world::Commands& to) {
  std::optional<std::string> fault;
  world::for_each_row(packed, [&](auto i) {
    if (fault) return;
    constexpr auto& row = std::get<i>(packed);
    constexpr auto& channel =
        std::get<world::row_of(world::commanded, row.values)>(world::commanded);
    fault = read_channel<i>(from, to);
    const std::size_t count = (to.*row.values).size(), expected = (like.*row.values).size();
    if (fault || count == expected) return;
    fault = fmt::format("the array {} has {} values; the world has {} {}", array_name(channel),
                        count, expected, channel.device_words);
  });
  if (!fault) fault = read_radio_messages(from, layout, state, to.radio_messages);
  if (!fault) fault = read_pushes(from, layout, state, to.pushes);
  if (!fault) fault = read_floor_paints(from, to.floor_paints);
  if (!fault) fault = read_markers(from, layout, to.markers);
  for (std::size_t i = 0; !fault && i < to.device_commands.size(); ++i) {
    const world::DeviceCommand& field = *layout.device_commands[i];
    if (to.device_commands[i] >= field.least && to.device_commands[i] <= field.most) continue;
    fault = fmt::format("the command number {} of a device must be from {} to {}", i, field.least,
                        field.most);
  }
  return fault;
}

void StatePacker::pack(std::uint64_t epoch, const world::State& state, v1::ExactState& to) {
  const bool is_complete = last_.size() != state.links.size();
  to.set_epoch(epoch);
  to.set_tick(state.tick);
  to.set_is_complete(is_complete);
  for (std::size_t i = 0; i < state.links.size(); ++i) {
    const LinkValues values = values_of(state.links[i]);
    if (!is_complete) {
      if (is_same(values, values_of(last_[i]))) continue;
      to.add_links(static_cast<std::uint32_t>(i));
    }
    to.mutable_values()->Add(values.begin(), values.end());
  }
  last_ = state.links;
}

std::optional<std::string> unpack(const v1::ExactState& from, std::vector<world::LinkState>& to) {
  const auto count = static_cast<std::size_t>(from.values_size()) / link_width;
  const auto listed = static_cast<std::size_t>(from.links_size());
  if (static_cast<std::size_t>(from.values_size()) % link_width != 0 ||
      (from.is_complete() ? listed > 0 : listed != count)) {
    return fmt::format("the state of tick {} has {} values for {} links; there must be {} each",
                       from.tick(), from.values_size(), listed, link_width);
  }
  for (const std::uint32_t link : from.links()) {
    if (link >= to.size()) {
      return fmt::format("the state of tick {} has a link number {}; the state before has {}",
                         from.tick(), link, to.size());
    }
  }
  if (from.is_complete()) to.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t link = from.is_complete() ? i : from.links(static_cast<int>(i));
    to[link] = link_of(from.values().data() + i * link_width);
  }
  return std::nullopt;
}

}  // namespace ziggurat::recording
