#pragma once
// Comparison of a robot's commands with the recorded ones.

#include <optional>
#include <string>

#include "world/commands.h"
#include "world/layout.h"

namespace ziggurat::replay {

struct CommandDifference {
  std::string device;  ///< as `joint_targets of 'left'`
  std::string recorded, now;
};

/// The first value of this robot that differs, bit by bit.
/// @param robot  into Layout::robots
std::optional<CommandDifference> first_difference(const world::Layout& layout, std::size_t robot,
                                                  const world::Commands& recorded,
                                                  const world::Commands& now);

}  // namespace ziggurat::replay
