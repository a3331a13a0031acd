// SPDX-License-Identifier: MIT
#include "wire/command_limits.h"

#include <algorithm>

#include "world/limits.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {
namespace {

constexpr std::size_t kibibyte = std::size_t{1} << 10, mebibyte = std::size_t{1} << 20;

constexpr std::size_t bytes_per_value = 64;  // of a number in either form, with what is around it
constexpr std::size_t bytes_per_tag = kibibyte;
constexpr std::size_t bytes_per_metric = 128;  // in either form, and of its fields
constexpr std::size_t metrics_per_robot = 100;
constexpr std::size_t bytes_per_robot =
    2 * kibibyte + metrics_per_robot * bytes_per_metric;     // 2 KiB: log lines
constexpr std::size_t radio_bytes_per_robot = 4 * kibibyte;  // of those that send
constexpr std::size_t radio_bytes_per_field = 64;
constexpr std::size_t bytes_per_marker = 256;  // in either form, and of its fields
constexpr std::size_t markers_per_robot = 16, markers_of_all = 2048;  // of those that draw
constexpr std::size_t longest_json = 24 * mebibyte;

/// Size of the parts that all robots of a session share [bytes].
struct Shared {
  std::size_t any;
  std::size_t radios;  // if one of the robots sends
};
constexpr Shared shared_in_binary{512 * kibibyte, 2 * mebibyte};
constexpr Shared shared_in_json{64 * kibibyte, 128 * kibibyte};

/// Size of the values of the robot's devices without radios in binary form [bytes].
std::size_t bytes_of(const world::RobotLayout& robot, const world::Layout& layout) {
  const std::size_t values = robot.joint_actuators.count + robot.leds.count +
                             robot.directional_leds.count + robot.tags.count + robot.magnets.count +
                             2 * robot.wheels.count + 3 * robot.turrets.count +
                             robot.device_commands.count;
  std::size_t bytes = bytes_per_robot + bytes_per_value * values + bytes_per_tag * robot.tags.count;
  for (std::size_t i = 0; i < robot.range_and_bearing.count; ++i) {
    bytes += layout.range_and_bearing[robot.range_and_bearing.begin + i].data.count;
  }
  return bytes;
}

bool sends(const world::RobotLayout& robot, const world::Layout& layout) {
  const auto begin = layout.radios.begin() + static_cast<std::ptrdiff_t>(robot.radios.begin);
  return std::any_of(begin, begin + static_cast<std::ptrdiff_t>(robot.radios.count),
                     [](const world::RadioLayout& radio) { return radio.sends; });
}

}  // namespace

CommandLimits command_limits(const Roster& roster, const world::Layout& layout, Encoding encoding) {
  const bool is_json = encoding == Encoding::json;
  const Shared& shared = is_json ? shared_in_json : shared_in_binary;
  std::size_t senders = 0, drawers = 0, tags = 0, bytes = shared.any;
  for (const std::size_t index : roster.robots) {
    const world::RobotLayout& robot = layout.robots[index];
    senders += sends(robot, layout) ? 1 : 0;
    drawers += robot.draws_markers ? 1 : 0;
    tags += robot.tags.count;
    bytes += bytes_of(robot, layout);
  }
  if (tags > 0) bytes += world::most_tag_payload_bytes;
  if (drawers > 0) bytes += bytes_per_marker * (markers_of_all + drawers * markers_per_robot);
  std::size_t by_radio = senders > 0 ? shared.radios + senders * radio_bytes_per_robot : 0;
  if (is_json) {  // base64
    bytes += bytes / 3;
    by_radio += by_radio / 3;
  }
  const std::size_t most = is_json ? std::min(bytes + by_radio, longest_json) : bytes + by_radio;
  return {most, std::min(most_fields, bytes / bytes_per_field + by_radio / radio_bytes_per_field)};
}

std::size_t count_fields(std::string_view bytes) {
  return v1::count_fields(bytes, *v1::ClientMessage::descriptor(), most_fields);
}

std::size_t count_json_values(std::string_view text) {
  std::size_t values = 0;
  bool is_text = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char each = text[i];
    if (each == '"') is_text = !is_text;
    if (is_text && each == '\\') ++i;
    if (!is_text && (each == ',' || each == '[' || each == '{')) ++values;
  }
  return values;
}

}  // namespace ziggurat::wire
