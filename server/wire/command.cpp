#include "wire/command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wire/fault.h"
#include "wire/positions.h"

namespace ziggurat::wire {
namespace {

/// Which robot of the session, and which of its actuators, the value at `index` is for.
std::pair<std::size_t, std::size_t> owner(const v1::Command& command, const Packing& packing,
                                          std::size_t index) {
  const auto all = command.robots().empty();
  const std::size_t count = all ? packing.robots.size() : command.robots().size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t position = all ? i : command.robots(static_cast<int>(i));
    if (index < packing.robots[position].count) return {position, index};
    index -= packing.robots[position].count;
  }
  return {0, 0};  // not reached: the length was checked
}

std::optional<Fault> check_joint_targets(const v1::Command& command, const Roster& roster,
                                         const world::Layout& layout) {
  const auto& targets = command.joint_targets();
  if (targets.empty()) return std::nullopt;
  std::size_t expected = command.robots().empty() ? roster.joint_actuators.count : 0;
  for (const std::uint32_t position : command.robots()) {
    expected += roster.joint_actuators.robots[position].count;
  }
  if (static_cast<std::size_t>(targets.size()) != expected) {
    return make_fault(ErrorCode::bad_value, "joint_targets",
                      fmt::format("{} joint targets were given; the robots of this command have {} "
                                  "joint actuators.",
                                  targets.size(), expected));
  }
  const auto bad = std::find_if(targets.begin(), targets.end(),
                                [](double target) { return !std::isfinite(target); });
  if (bad == targets.end()) return std::nullopt;
  const auto index = static_cast<std::size_t>(bad - targets.begin());
  const auto [position, actuator] = owner(command, roster.joint_actuators, index);
  const world::RobotLayout& robot = layout.robots[roster.robots[position]];
  const std::string& joint = layout.joint_actuators[robot.joint_actuators.begin + actuator].id;
  return make_fault(ErrorCode::bad_value, "joint_targets",
                    fmt::format("The target of joint '{}' of robot '{}' is {}; it must be finite.",
                                joint, robot.id, *bad),
                    robot.id);
}

}  // namespace

std::optional<Fault> check(const google::protobuf::RepeatedPtrField<v1::LogLine>& log,
                           const Roster& roster) {
  for (const v1::LogLine& line : log) {
    if (line.robot() >= roster.robots.size()) {
      return make_fault(ErrorCode::unknown_robot, "log",
                        fmt::format("The session has {} robots; there is none at position {}.",
                                    roster.robots.size(), line.robot()));
    }
  }
  return std::nullopt;
}

std::optional<Fault> check(const v1::Command& command, const Roster& roster,
                           const world::Layout& layout) {
  if (auto found = check_positions(command.robots(), roster, layout)) return found;
  if (auto found = check_joint_targets(command, roster, layout)) return found;
  return check(command.log(), roster);
}

void apply(const v1::Command& command, const Roster& roster, world::Commands& commands) {
  if (command.joint_targets().empty()) return;
  const double* values = command.joint_targets().data();
  double* targets = commands.joint_targets.data();
  const Packing& packing = roster.joint_actuators;
  if (!command.robots().empty()) {
    for (const std::uint32_t position : command.robots()) {
      const Packing::Stretch& robot = packing.robots[position];
      std::copy_n(values, robot.count, targets + robot.flat);
      values += robot.count;
    }
    return;
  }
  if (roster.gone_count == 0) {
    for (const Packing::Stretch& piece : packing.stretches) {
      std::copy_n(values + piece.packed, piece.count, targets + piece.flat);
    }
    return;
  }
  for (std::size_t i = 0; i < packing.robots.size(); ++i) {
    const Packing::Stretch& robot = packing.robots[i];
    if (roster.gone[i]) continue;
    std::copy_n(values + robot.packed, robot.count, targets + robot.flat);
  }
}

void append(const google::protobuf::RepeatedPtrField<v1::LogLine>& log, const Roster& roster,
            std::vector<LogLine>& lines) {
  for (const v1::LogLine& line : log) {
    lines.push_back({roster.robots[line.robot()], line.error(), line.text()});
  }
}

}  // namespace ziggurat::wire
