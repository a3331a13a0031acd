// SPDX-License-Identifier: MIT
#pragma once
// Places in the plane, in the frame of the robot's map.

#include <cmath>

namespace assembly {

inline constexpr double pi = 3.14159265358979323846;

struct Point {
  double x = 0, y = 0;  ///< [m]
};

struct Pose : Point {
  double yaw = 0;  ///< [rad]; of a block's side: its outward normal
};

/// Point this far ahead of a robot at this pose, or along a side's normal [m].
inline Point ahead_of(const Pose& from, double distance) {
  return {from.x + distance * std::cos(from.yaw), from.y + distance * std::sin(from.yaw)};
}

/// The equivalent angle within half a turn of 0 [rad].
inline double wrapped(double angle) { return std::atan2(std::sin(angle), std::cos(angle)); }

/// As `x ^ 2` of Lua: the C library's pow, whose last bit is sometimes not that of x * x. The run
/// can thus have the same hash as that of the script.
inline double squared(double x) {
  static const volatile double exponent = 2;  // a compiler that knows it writes x * x
  return std::pow(x, exponent);
}

inline double distance_between(const Point& a, const Point& b) {
  return std::sqrt(squared(a.x - b.x) + squared(a.y - b.y));
}

inline bool is_within(const Point& a, const Point& b, double distance) {
  return squared(a.x - b.x) + squared(a.y - b.y) < squared(distance);
}

}  // namespace assembly
