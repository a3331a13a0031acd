// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "wire/command.h"
#include "wire/messages.h"
#include "world/limits.h"

namespace ziggurat::wire {
namespace {

using RadioMessages = google::protobuf::RepeatedPtrField<v1::RadioMessage>;
constexpr const char* field = "radio_messages";

/// A radio of the session as the world knows it.
struct Found {
  std::size_t position;  // of its robot in the session
  std::size_t radio;     // into Layout::radios
};

Found find(const Roster& roster, std::size_t radio) {
  const std::size_t position = roster.radios.owner(radio);
  const Packing::Stretch& robot = roster.radios.robots[position];
  return {position, robot.flat + radio - robot.packed};
}

std::optional<Fault> check(const v1::RadioMessage& message, const Roster& roster,
                           const world::Layout& layout, const std::vector<bool>& named) {
  if (message.radio() >= roster.radios.count) {
    return make_fault(ErrorCode::unknown_device, field,
                      fmt::format("The robots of this session have {} radios; there is none at "
                                  "position {}.",
                                  roster.radios.count, message.radio()));
  }
  const Found found = find(roster, message.radio());
  const world::RadioLayout& radio = layout.radios[found.radio];
  const std::string& robot = layout.robots[roster.robots[found.position]].id;
  if (!named.empty() && !named[found.position]) {
    return make_fault(ErrorCode::not_yours, field,
                      fmt::format("Radio '{}' belongs to robot '{}', which this command does not "
                                  "speak for.",
                                  radio.id, robot),
                      robot);
  }
  if (!radio.sends) {
    return make_fault(ErrorCode::unknown_device, field,
                      fmt::format("Radio '{}' of robot '{}' can't send: the controller has no "
                                  "actuator for radios.",
                                  radio.id, robot),
                      robot);
  }
  if (message.payload().size() > world::most_radio_message_bytes) {
    return make_fault(
        ErrorCode::too_large, field,
        fmt::format("A message of radio '{}' of robot '{}' has {} bytes; {} are "
                    "allowed.",
                    radio.id, robot, message.payload().size(), world::most_radio_message_bytes),
        robot);
  }
  return std::nullopt;
}

/// Checks the totals that a robot sends at one tick. Each message was checked before.
std::optional<Fault> check_totals(const RadioMessages& messages, const Roster& roster,
                                  const world::Layout& layout) {
  struct Total {
    std::size_t messages = 0;
    std::size_t bytes = 0;
    bool is_too_large() const {
      return messages > world::most_radio_messages_per_robot ||
             bytes > world::most_radio_bytes_per_robot;
    }
  };
  // Mostly all robots together send less than one may.
  Total all{static_cast<std::size_t>(messages.size())};
  for (const v1::RadioMessage& message : messages) all.bytes += message.payload().size();
  if (!all.is_too_large()) return std::nullopt;

  std::vector<Total> totals(roster.robots.size());
  for (const v1::RadioMessage& message : messages) {
    const std::size_t position = roster.radios.owner(message.radio());
    Total& total = totals[position];
    ++total.messages;
    total.bytes += message.payload().size();
    if (!total.is_too_large()) continue;
    const std::string& robot = layout.robots[roster.robots[position]].id;
    return make_fault(
        ErrorCode::too_large, field,
        fmt::format("Robot '{}' sends more than {} bytes or {} messages at this "
                    "tick.",
                    robot, world::most_radio_bytes_per_robot, world::most_radio_messages_per_robot),
        robot);
  }
  return std::nullopt;
}

}  // namespace

std::optional<Fault> check_radio_messages(const v1::Command& command, const Roster& roster,
                                          const world::Layout& layout) {
  const RadioMessages& messages = command.radio_messages();
  if (messages.empty()) return std::nullopt;
  std::vector<bool> named(command.robots().empty() ? 0 : roster.robots.size(), false);
  for (const std::uint32_t position : command.robots()) named[position] = true;
  for (const v1::RadioMessage& message : messages) {
    if (auto found = check(message, roster, layout, named)) return found;
  }
  return check_totals(messages, roster, layout);
}

void apply_radio_messages(const v1::Command& command, const Roster& roster,
                          world::RadioMessages& messages) {
  for (const v1::RadioMessage& message : command.radio_messages()) {
    const Found found = find(roster, message.radio());
    if (roster.gone[found.position]) continue;
    const std::string& payload = message.payload();
    messages.add(found.radio,
                 std::span(reinterpret_cast<const std::uint8_t*>(payload.data()), payload.size()));
  }
}

}  // namespace ziggurat::wire
