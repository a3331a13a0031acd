// SPDX-License-Identifier: MIT
#pragma once
// Comparison of two states, and of a robot's commands with the recorded ones.

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "world/commands.h"
#include "world/layout.h"
#include "world/state.h"

namespace ziggurat::replay {

struct Difference {
  std::size_t link = 0;  ///< into Layout::links
  std::string field;     ///< as `position.x`
  double a = 0, b = 0;
};

/// The first value that has other bits; of links that both have.
std::optional<Difference> first_difference(std::span<const world::LinkState> a,
                                           std::span<const world::LinkState> b);

/// Distance between the poses of two states.
struct Distance {
  double greatest = 0;   ///< [m]
  double mean = 0;       ///< over all links [m]
  double angle = 0;      ///< the greatest between two orientations [rad]
  std::size_t link = 0;  ///< the one with the greatest
};
/// Distance over the links that both have. All zero if there are none.
Distance distance(std::span<const world::LinkState> a, std::span<const world::LinkState> b);

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
