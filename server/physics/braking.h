#pragma once

#include <cmath>

namespace ziggurat::physics {

/// Fastest approach from which a motor of this strength can still stop at the target. With
/// deceleration a in steps of h, the distance is the sum of the remaining velocities.
/// @param distance  to the target [m or rad];  @param deceleration  [m/s^2 or rad/s^2], more than 0
/// @param length  of a substep [s]
/// @return  [m/s or rad/s]
inline double stoppable_velocity(double distance, double deceleration, double length) {
  const double step = deceleration * length;  // [m/s] lost per substep
  return step * (std::sqrt(0.25 + 2 * distance / (step * length)) - 0.5);
}

}  // namespace ziggurat::physics
