#include "wire/command_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "wire/command_packing.h"
#include "world/limits.h"

namespace ziggurat::wire {
namespace {

/// One rule for all values of a field: the first that breaks it is named.
template <typename Values, typename Devices, typename IsGood, typename Sentence>
std::optional<Fault> check_each(const v1::Command& command, const Roster& roster,
                                const world::Layout& layout, const Packing& packing,
                                const Values& values, const Devices& devices, const char* field,
                                ErrorCode code, IsGood is_good, Sentence sentence) {
  const auto bad = std::find_if_not(values.begin(), values.end(), is_good);
  if (bad == values.end()) return std::nullopt;
  const auto index = static_cast<std::size_t>(bad - values.begin());
  const auto [robot, device] = owner(command, roster, layout, packing, index);
  return make_fault(code, field, sentence(devices[device].id, robot->id, *bad), robot->id);
}

bool is_finite(double value) { return std::isfinite(value); }
bool is_color(std::uint32_t color) { return color <= 0xFFFFFF; }
bool is_payload(const std::string& payload) {
  return payload.size() <= world::most_tag_payload_bytes;
}

std::string infinite_target(const std::string& joint, const std::string& robot, double value) {
  return fmt::format("The target of joint '{}' of robot '{}' is {}; it must be finite.", joint,
                     robot, value);
}

std::string infinite_current(const std::string& magnet, const std::string& robot, double value) {
  return fmt::format("The current of magnet '{}' of robot '{}' is {}; it must be finite.", magnet,
                     robot, value);
}

std::string no_color(const std::string& led, const std::string& robot, std::uint32_t color) {
  return fmt::format("The color of LED '{}' of robot '{}' is {:#x}; it must be 0xRRGGBB.", led,
                     robot, color);
}

std::string long_payload(const std::string& tag, const std::string& robot,
                         const std::string& payload) {
  return fmt::format("The payload of tag '{}' of robot '{}' has {} bytes; {} are allowed.", tag,
                     robot, payload.size(), world::most_tag_payload_bytes);
}

std::optional<Fault> check_counts(const v1::Command& command, const Roster& roster) {
  const auto check = [&](const Packing& packing, auto count, const Field& field) {
    return check_count(command, packing, static_cast<std::size_t>(count), field);
  };
  if (auto found = check(roster.joint_actuators, command.joint_targets_size(),
                         {"joint_targets", "joint targets", "joint actuators"})) {
    return found;
  }
  if (auto found = check(roster.leds, command.led_colors_size(),
                         {"led_colors", "LED colors", "LEDs with an actuator"})) {
    return found;
  }
  if (auto found = check(roster.directional_leds, command.directional_led_colors_size(),
                         {"directional_led_colors", "colors of directional LEDs",
                          "directional LEDs with an actuator"})) {
    return found;
  }
  if (auto found = check(roster.tags, command.tag_payloads_size(),
                         {"tag_payloads", "payloads", "tags with an actuator"})) {
    return found;
  }
  if (auto found = check(roster.magnets, command.magnet_currents_size(),
                         {"magnet_currents", "currents", "magnets with an actuator"})) {
    return found;
  }
  return check(roster.range_and_bearing_data, command.range_and_bearing_data().size(),
               {"range_and_bearing_data", "bytes", "bytes of range-and-bearing data to set"});
}

/// Copies a field's values to where they stand in the world. `values` and `flat` are iterators to
/// the first of each.
template <typename Values, typename Flat>
void copy(const v1::Command& command, const Roster& roster, const Packing& packing, Values values,
          Flat flat) {
  const auto at = [](auto begin, std::size_t offset) {
    return begin + static_cast<std::ptrdiff_t>(offset);
  };
  if (!command.robots().empty()) {
    for (const std::uint32_t position : command.robots()) {
      const Packing::Stretch& robot = packing.robots[position];
      std::copy_n(values, robot.count, at(flat, robot.flat));
      values = at(values, robot.count);
    }
    return;
  }
  if (roster.gone_count == 0) {
    for (const Packing::Stretch& piece : packing.stretches) {
      std::copy_n(at(values, piece.packed), piece.count, at(flat, piece.flat));
    }
    return;
  }
  for (std::size_t i = 0; i < packing.robots.size(); ++i) {
    const Packing::Stretch& robot = packing.robots[i];
    if (roster.gone[i]) continue;
    std::copy_n(at(values, robot.packed), robot.count, at(flat, robot.flat));
  }
}

}  // namespace

std::optional<Fault> check_values(const v1::Command& command, const Roster& roster,
                                  const world::Layout& layout) {
  if (auto found = check_counts(command, roster)) return found;
  const auto check = [&](const Packing& packing, const auto& values, const auto& devices,
                         const char* field, ErrorCode code, auto is_good, auto sentence) {
    return check_each(command, roster, layout, packing, values, devices, field, code, is_good,
                      sentence);
  };
  if (auto found = check(roster.joint_actuators, command.joint_targets(), layout.joint_actuators,
                         "joint_targets", ErrorCode::bad_value, is_finite, infinite_target)) {
    return found;
  }
  if (auto found = check(roster.leds, command.led_colors(), layout.leds, "led_colors",
                         ErrorCode::bad_value, is_color, no_color)) {
    return found;
  }
  if (auto found =
          check(roster.directional_leds, command.directional_led_colors(), layout.directional_leds,
                "directional_led_colors", ErrorCode::bad_value, is_color, no_color)) {
    return found;
  }
  if (auto found = check(roster.tags, command.tag_payloads(), layout.tags, "tag_payloads",
                         ErrorCode::too_large, is_payload, long_payload)) {
    return found;
  }
  return check(roster.magnets, command.magnet_currents(), layout.magnets, "magnet_currents",
               ErrorCode::bad_value, is_finite, infinite_current);
}

void apply_values(const v1::Command& command, const Roster& roster, world::Commands& commands) {
  const auto apply = [&](const Packing& packing, const auto& values, auto& flat) {
    if (!values.empty()) copy(command, roster, packing, values.begin(), flat.begin());
  };
  apply(roster.joint_actuators, command.joint_targets(), commands.joint_targets);
  apply(roster.leds, command.led_colors(), commands.led_colors);
  apply(roster.directional_leds, command.directional_led_colors(), commands.directional_led_colors);
  apply(roster.tags, command.tag_payloads(), commands.tag_payloads);
  apply(roster.magnets, command.magnet_currents(), commands.magnet_currents);
  apply(roster.range_and_bearing_data, command.range_and_bearing_data(),
        commands.range_and_bearing_data);
}

}  // namespace ziggurat::wire
