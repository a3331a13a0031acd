// SPDX-License-Identifier: MIT
#include "recording/replay/difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

namespace ziggurat::replay {
namespace {

constexpr std::array<std::string_view, 13> field_names{
    "position.x",        "position.y",    "position.z",         "orientation.w",
    "orientation.x",     "orientation.y", "orientation.z",      "velocity.x",
    "velocity.y",        "velocity.z",    "angular_velocity.x", "angular_velocity.y",
    "angular_velocity.z"};

std::array<double, 13> values_of(const world::LinkState& link) {
  std::array<double, 13> values{};
  const auto pose = world::numbers(link.pose);
  std::copy(pose.begin(), pose.end(), values.begin());
  std::copy_n(link.velocity.data(), 3, values.begin() + 7);
  std::copy_n(link.angular_velocity.data(), 3, values.begin() + 10);
  return values;
}

constexpr std::size_t longest_text = 60;  // of a text that is shown [bytes]

/// Bytes as text that a terminal takes.
std::string printable(std::string_view bytes) {
  std::string text = fmt::format("{} bytes '", bytes.size());
  for (const char c : bytes.substr(0, longest_text)) {
    const auto code = static_cast<unsigned char>(c);
    text += code >= 0x20 && code < 0x7F ? std::string(1, c) : fmt::format("\\x{:02x}", code);
  }
  return text + (bytes.size() > longest_text ? "…'" : "'");
}

bool is_same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
bool is_same(const world::WheelsCommand& a, const world::WheelsCommand& b) {
  return is_same(a.left, b.left) && is_same(a.right, b.right);
}
template <class T>
bool is_same(const T& a, const T& b) {
  return a == b;
}

std::string text_of(double value) { return fmt::format("{}", value); }
std::string text_of(world::Color value) { return fmt::format("0x{:06X}", value); }
std::string text_of(std::uint8_t value) { return fmt::format("{}", value); }
std::string text_of(const std::string& value) { return printable(value); }
std::string text_of(const world::WheelsCommand& v) {
  return fmt::format("{} (left), {} (right)", v.left, v.right);
}
std::string text_of(world::TurretMode value) {
  return fmt::format("{}", static_cast<unsigned>(value));
}

std::vector<std::string_view> sent(const world::RadioMessages& messages, std::size_t radio) {
  std::vector<std::string_view> found;
  for (const auto& entry : messages.entries) {
    if (entry.radio != radio) continue;
    const auto payload = messages.payload(entry);
    found.emplace_back(reinterpret_cast<const char*>(payload.data()), payload.size());
  }
  return found;
}

std::optional<CommandDifference> radio_difference(const world::Layout& layout,
                                                  const world::Range& radios,
                                                  const world::RadioMessages& recorded,
                                                  const world::RadioMessages& now) {
  for (std::size_t radio = radios.begin; radio < radios.end(); ++radio) {
    const auto a = sent(recorded, radio), b = sent(now, radio);
    for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
      if (i < a.size() && i < b.size() && a[i] == b[i]) continue;
      return CommandDifference{fmt::format("radio message {} of '{}'", i, layout.radios[radio].id),
                               i < a.size() ? printable(a[i]) : "nothing",
                               i < b.size() ? printable(b[i]) : "nothing"};
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<Difference> first_difference(std::span<const world::LinkState> a,
                                           std::span<const world::LinkState> b) {
  for (std::size_t link = 0; link < std::min(a.size(), b.size()); ++link) {
    const auto of_a = values_of(a[link]), of_b = values_of(b[link]);
    for (std::size_t i = 0; i < field_names.size(); ++i) {
      if (std::bit_cast<std::uint64_t>(of_a[i]) == std::bit_cast<std::uint64_t>(of_b[i])) continue;
      return Difference{link, std::string(field_names[i]), of_a[i], of_b[i]};
    }
  }
  return std::nullopt;
}

Distance distance(std::span<const world::LinkState> a, std::span<const world::LinkState> b) {
  Distance result;
  const std::size_t count = std::min(a.size(), b.size());
  for (std::size_t link = 0; link < count; ++link) {
    const double apart = (a[link].pose.position - b[link].pose.position).norm();
    result.mean += apart / static_cast<double>(count);
    result.angle =
        std::max(result.angle, a[link].pose.orientation.angularDistance(b[link].pose.orientation));
    if (apart <= result.greatest) continue;
    result.greatest = apart;
    result.link = link;
  }
  return result;
}

std::optional<CommandDifference> first_difference(const world::Layout& layout, std::size_t robot,
                                                  const world::Commands& recorded,
                                                  const world::Commands& now) {
  const world::RobotLayout& ranges = layout.robots[robot];
  std::optional<CommandDifference> found;
  world::for_each_channel(world::commanded, [&](auto i) {
    constexpr auto& channel = std::get<i>(world::commanded);
    const auto& a = recorded.*channel.values;
    const auto& b = now.*channel.values;
    const world::Range devices = channel.devices(layout, ranges);
    for (std::size_t d = devices.begin; d < devices.end() && !found; ++d) {
      if (is_same(a.at(d), b.at(d))) continue;
      std::string device = channel.recorded ? channel.recorded : channel.name;
      if constexpr (channel.id != nullptr) {
        device += fmt::format(" of '{}'", channel.id(layout, d));
      } else if (devices.count > 1) {
        device += fmt::format("[{}]", d - devices.begin);
      }
      found = CommandDifference{std::move(device), text_of(a[d]), text_of(b[d])};
    }
  });
  if (found) return found;
  return radio_difference(layout, ranges.radios, recorded.radio_messages, now.radio_messages);
}

}  // namespace ziggurat::replay
