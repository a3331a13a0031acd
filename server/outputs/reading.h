// SPDX-License-Identifier: MIT
#pragma once
// One robot at one tick, by name.

#include <cstddef>

#include "world/commands.h"
#include "world/layout.h"
#include "world/state.h"
#include "ziggurat/v1/recording.pb.h"

namespace ziggurat::outputs {

/// Everything of one tick that a reading is taken from.
struct Moment {
  const world::Layout& layout;
  const world::State& state;
  const world::Observations& observations;
  const world::Commands& commands;
};

/// The robot that a camera belongs to.
/// @param camera  into Layout::cameras
const world::RobotLayout& robot_with(std::size_t camera, const world::Layout& layout);

/// @param robot  into Layout::robots
v1::Reading make_reading(const Moment& moment, std::size_t robot);

}  // namespace ziggurat::outputs
