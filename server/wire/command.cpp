// SPDX-License-Identifier: MIT
#include "wire/command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <tuple>
#include <type_traits>
#include <utility>

#include "wire/devices.h"
#include "wire/messages.h"

namespace ziggurat::wire {
namespace {

/// The robots of a message: positions in the session, of robots that have not left, each once. A
/// client may not know yet which were taken over.
std::optional<Fault> check_positions(const google::protobuf::RepeatedField<std::uint32_t>& robots,
                                     const Roster& roster, const world::Layout& layout) {
  std::vector<bool> named(robots.empty() ? 0 : roster.robots.size(), false);
  for (const std::uint32_t position : robots) {
    if (auto found = check_position(position, roster, "robots")) return found;
    const std::string& id = layout.robots[roster.robots[position]].id;
    if (roster.gone[position] && !roster.taken[position]) {
      return make_fault(ErrorCode::not_yours, "robots",
                        fmt::format("Robot '{}' has left the run; leave it out of `robots`.", id),
                        id);
    }
    if (named[position]) {
      return make_fault(ErrorCode::bad_value, "robots",
                        fmt::format("Robot '{}' (position {}) is named twice.", id, position), id);
    }
    named[position] = true;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Fault> check(const google::protobuf::RepeatedPtrField<v1::LogLine>& log,
                           const Roster& roster) {
  for (const v1::LogLine& line : log) {
    if (auto found = check_position(line.robot(), roster, "log")) return found;
  }
  return std::nullopt;
}

std::optional<Fault> check(const v1::Command& command, const Roster& roster,
                           const world::Layout& layout) {
  if (auto found = check_positions(command.robots(), roster, layout)) return found;
  if (auto found = check_channels(command, roster, layout)) return found;
  if (auto found = check_radio_messages(command, roster, layout)) return found;
  if (auto found = check_markers(command, roster, layout)) return found;
  return check(command.log(), roster);
}

std::optional<Fault> check(const v1::Leave& leave, const Roster& roster,
                           const world::Layout& layout) {
  if (leave.reason() != v1::Leave::DONE && leave.reason() != v1::Leave::FAILED) {
    return make_fault(ErrorCode::bad_value, "reason",
                      "The reason of a Leave must be DONE or FAILED.");
  }
  if (auto found = check_positions(leave.robots(), roster, layout)) return found;
  return check(leave.log(), roster);
}

void apply(const v1::Command& command, const Roster& roster, world::Commands& commands) {
  apply_channels(command, roster, commands);
  apply_radio_messages(command, roster, commands.radio_messages);
  apply_markers(command, roster, commands.markers);
}

void append(const google::protobuf::RepeatedPtrField<v1::LogLine>& log, const Roster& roster,
            std::vector<LogLine>& lines) {
  for (const v1::LogLine& line : log) {
    if (roster.taken[line.robot()]) continue;
    lines.push_back({roster.robots[line.robot()], line.error(), line.text()});
  }
}

void reset_commands(const world::Layout& layout, std::size_t robot, world::Commands& commands) {
  world::for_each_channel(world::commanded, [&](auto i) {
    const auto& channel = std::get<i>(world::commanded);
    if (channel.released != world::Released::zeroed) return;
    auto& values = commands.*channel.values;
    const world::Range range = channel.devices(layout, layout.robots[robot]);
    std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(range.begin), range.count,
                typename std::decay_t<decltype(values)>::value_type{});
  });
  const world::Range& described = layout.robots[robot].device_commands;
  for (std::size_t i = described.begin; i < described.end(); ++i) {
    commands.device_commands[i] = layout.device_commands[i]->released;
  }
}

void forget_radio_messages(const Roster& roster, world::RadioMessages& messages) {
  if (messages.entries.empty()) return;
  const auto& pieces = roster.radios.stretches;  // ascending
  const auto is_own = [&](std::size_t radio) {
    const auto after = std::ranges::upper_bound(pieces, radio, {}, &Packing::Stretch::flat);
    if (after == pieces.begin()) return false;
    const Packing::Stretch& piece = *std::prev(after);
    if (radio >= piece.flat + piece.count) return false;
    return !roster.taken[roster.radios.owner(piece.packed + radio - piece.flat)];
  };
  world::RadioMessages others;  // without the bytes of those that are forgotten
  for (const world::RadioMessages::Entry& entry : messages.entries) {
    if (!is_own(entry.radio)) others.add(entry.radio, messages.payload(entry));
  }
  messages = std::move(others);
}

namespace {

constexpr std::size_t longest_name = 64;  // [bytes]

bool is_name(std::string_view text) {
  const auto may_stand = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  return !text.empty() && text.size() <= longest_name && std::ranges::all_of(text, may_stand);
}

}  // namespace

std::optional<Fault> check(const google::protobuf::RepeatedPtrField<v1::Metric>& metrics,
                           const Roster& roster) {
  for (const v1::Metric& metric : metrics) {
    if (auto found = check_position(metric.robot(), roster, "metrics")) return found;
  }
  return check_names_and_values(metrics);
}

std::optional<Fault> check_names_and_values(
    const google::protobuf::RepeatedPtrField<v1::Metric>& metrics) {
  for (const v1::Metric& metric : metrics) {
    if (!is_name(metric.name())) {
      return make_fault(ErrorCode::bad_value, "metrics",
                        fmt::format("The name of a metric must have 1 to {} letters, digits, '_', "
                                    "'-' or '.'.",
                                    longest_name));
    }
    if (!std::isfinite(metric.value())) {
      return make_fault(ErrorCode::bad_value, "metrics",
                        fmt::format("The metric '{}' must be finite.", metric.name()));
    }
  }
  return std::nullopt;
}

void append(const google::protobuf::RepeatedPtrField<v1::Metric>& metrics, const Roster& roster,
            std::vector<Metric>& to) {
  for (const v1::Metric& metric : metrics) {
    if (roster.taken[metric.robot()]) continue;
    to.push_back({roster.robots[metric.robot()], metric.name(), metric.value()});
  }
}

}  // namespace ziggurat::wire
