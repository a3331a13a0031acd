#include "wire/command_packing.h"

#include <fmt/format.h>

namespace ziggurat::wire {

std::optional<Fault> check_count(const v1::Command& command, const Packing& packing,
                                 std::size_t count, const Field& field, std::size_t per_device) {
  if (count == 0) return std::nullopt;
  std::size_t expected = command.robots().empty() ? packing.count : 0;
  for (const std::uint32_t position : command.robots()) {
    expected += packing.robots[position].count;
  }
  if (count == per_device * expected) return std::nullopt;
  const std::string each = per_device == 1 ? "" : fmt::format(", {} values each", per_device);
  return make_fault(ErrorCode::bad_value, field.name,
                    fmt::format("{} {} were given; the robots of this command have {} {}{}.", count,
                                field.values, expected, field.devices, each));
}

std::pair<const world::RobotLayout*, std::size_t> owner(const v1::Command& command,
                                                        const Roster& roster,
                                                        const world::Layout& layout,
                                                        const Packing& packing, std::size_t index) {
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

}  // namespace ziggurat::wire
