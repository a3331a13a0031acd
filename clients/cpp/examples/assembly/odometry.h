// SPDX-License-Identifier: MIT
#pragma once
// The robot's pose from wheels and gyroscope. The wheels skid in turns, by an amount that changes
// with the load on each: so the gyroscope measures the turn, and the point about which the robot
// turns is learned from what the camera sees.

#include <ziggurat/ziggurat.h>

#include <array>

#include "../construction/builder.h"
#include "geometry.h"

namespace assembly {

struct Odometry {
  Pose pose;
  std::array<double, 2> pivot = {0.020, 0.032};  ///< before the wheels' middle, by `loaded` [m]
  double turned = 0;                             ///< in the last tick [rad]
};

/// Updates the pose; call it first in every step.
void reckon(Odometry& odometry, const construction::Builder& builder, const ziggurat::Imu& imu);

/// Distance of the point about which the robot turns, in front of its centre [m].
double pivot_ahead(const Odometry& odometry, bool loaded);
/// Pose at that point, with the robot's direction: a turn on the spot does not move it.
Pose pivot_of(const Odometry& odometry, bool loaded);

/// Something that stands still was seen this far from its place of the tick before [m].
void learn(Odometry& odometry, bool loaded, const Point& off);

}  // namespace assembly
