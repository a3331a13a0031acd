#include "wire/longest_command.h"

#include <algorithm>

#include "world/limits.h"

namespace ziggurat::wire {
namespace {

constexpr std::size_t bytes_per_value = 64;  // of a number in either form, with what is around it

/// What the robot's devices take in binary form [bytes].
std::size_t bytes_of(const world::RobotLayout& robot, const world::Layout& layout) {
  const std::size_t values = robot.joint_actuators.count + robot.leds.count +
                             robot.directional_leds.count + robot.tags.count + robot.magnets.count +
                             2 * robot.wheels.count + 3 * robot.turrets.count;
  std::size_t bytes = bytes_per_value * values + world::most_tag_payload_bytes * robot.tags.count;
  for (std::size_t i = 0; i < robot.range_and_bearing.count; ++i) {
    bytes += layout.range_and_bearing[robot.range_and_bearing.begin + i].data.count;
  }
  for (std::size_t i = 0; i < robot.radios.count; ++i) {
    if (!layout.radios[robot.radios.begin + i].sends) continue;
    constexpr std::size_t headers = bytes_per_value * world::most_radio_messages_per_robot / 2;
    return bytes + world::most_radio_bytes_per_robot + headers;  // of all of its radios together
  }
  return bytes;
}

}  // namespace

std::size_t longest_command(const Roster& roster, const world::Layout& layout, Encoding encoding) {
  std::size_t bytes = 0;
  for (const std::size_t robot : roster.robots) bytes += bytes_of(layout.robots[robot], layout);
  if (encoding == Encoding::binary) return command_allowance + bytes;
  return std::min(longest_json_command, command_allowance + bytes + bytes / 3);  // base64
}

}  // namespace ziggurat::wire
