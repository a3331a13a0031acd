#pragma once
// Which device of the world a packed value of a command is for.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "wire/fault.h"
#include "wire/messages.h"
#include "wire/roster.h"
#include "world/layout.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {

/// Part of a command, in words.
struct Field {
  const char* name;     ///< in the protocol
  const char* values;   ///< "joint targets"
  const char* devices;  ///< that they are for
};

/// `count` values must be none or `per_device` for each device of the command's robots.
std::optional<Fault> check_count(const v1::Command& command, const Packing& packing,
                                 std::size_t count, const Field& field, std::size_t per_device = 1);

/// The robot of the world that the device at `index` < count in the command belongs to, and the
/// place of the device in the world's list. The command's lengths are right.
std::pair<const world::RobotLayout*, std::size_t> owner(const v1::Command& command,
                                                        const Roster& roster,
                                                        const world::Layout& layout,
                                                        const Packing& packing, std::size_t index);

/// Calls visit(index, flat) for the devices of the command's robots, without those that are gone:
/// what is at `index` in the command is for the device at `flat` in the world.
template <typename Visit>
void for_each_device(const v1::Command& command, const Roster& roster, const Packing& packing,
                     Visit visit) {
  std::size_t index = 0;
  const auto visit_robot = [&](std::size_t position) {
    const Packing::Stretch& robot = packing.robots[position];
    for (std::size_t i = 0; i < robot.count && !roster.gone[position]; ++i) {
      visit(index + i, robot.flat + i);
    }
    index += robot.count;
  };
  for (const std::uint32_t position : command.robots()) visit_robot(position);
  if (!command.robots().empty()) return;
  for (std::size_t position = 0; position < packing.robots.size(); ++position) {
    visit_robot(position);
  }
}

}  // namespace ziggurat::wire
