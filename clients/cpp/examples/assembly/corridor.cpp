// SPDX-License-Identifier: MIT
#include "corridor.h"

#include <algorithm>
#include <cmath>

#include "assembler.h"

namespace assembly {
namespace {

constexpr double last_way = 0.17;  // straight way to the structure, for the steering to settle [m]
constexpr double robots_apart = 0.25;  // of robots at work, between their centres [m]
constexpr double in_reach = 0.45;      // farther away no robot can be lined up with a place [m]
// A robot that is less aside of a row of columns is lined up with it: they are 78 mm apart.
constexpr double same_row = 0.055;  // [m]

/// A point seen from a side [m].
struct Seen {
  double out = 0;    // along the side's normal
  double aside = 0;  // of the line through its middle
};

Seen seen_from(const Pose& side, const Point& point) {
  const double c = std::cos(side.yaw), s = std::sin(side.yaw);
  const double dx = point.x - side.x, dy = point.y - side.y;
  return {c * dx + s * dy, std::abs(c * dy - s * dx)};
}

bool is_in_corridor(const Pose& side, const Row& row, const Point& point) {
  const auto [out, aside] = seen_from(side, point);
  const double near_end = distance_of(row);
  const double beyond = out - std::clamp(out, near_end, near_end + last_way);
  return squared(beyond) + squared(aside) < squared(robots_apart);
}

bool is_anywhere_above(const Row& row) { return row.above && row.is_everywhere; }

/// Whether a robot at that point may want to attach a block where one is to come by this side.
/// @param wanted  by which row it wants to; null if it does not say so
bool is_same_place(const Pose& side, const Row& row, const Point& point, const Row* wanted) {
  const Seen seen = seen_from(side, point);
  const double half = 0.5 * construction::block;
  const double out = seen.out - (row.above ? -half : pitch - half);
  if (squared(out) + squared(seen.aside) > squared(in_reach)) return false;
  if (!wanted || (is_anywhere_above(*wanted) && is_anywhere_above(row))) return true;
  return !row.above && !wanted->above && std::abs(out) < same_row;
}

}  // namespace

double distance_of(const Row& row) { return construction::reach + (row.above ? 0 : pitch); }

Point start_of(const Pose& side, const Row& row) {
  return ahead_of(side, distance_of(row) + last_way);
}

bool is_corridor_taken(const Assembler& self, const Pose& side, const Row& row,
                       double own_distance) {
  const double near_end = distance_of(row);
  const Point start = start_of(side, row);
  return std::ranges::any_of(self.traffic.neighbours, [&](const Neighbour& other) {
    const Point point = place_of(other, self.odometry.pose);
    const auto [out, aside] = seen_from(side, point);
    const double distance = distance_between(point, start);
    const bool is_in_row = aside < 0.2 && out > near_end - 0.05 && out < near_end + last_way + 0.2;
    return (is_in_row && (other.holding || (other.asking && distance < own_distance))) ||
           distance < std::min(own_distance - 0.1, other.row > 0 ? 0.5 : 0.25);
  });
}

bool may_enter(Assembler& self, const Pose& side, const Row& row) {
  self.traffic.row = row.index;
  const auto place = [&](const Neighbour& other) { return place_of(other, self.odometry.pose); };
  return may_enter(
      self.traffic, self.random,
      [&](const Neighbour& other) { return is_in_corridor(side, row, place(other)); },
      [&](const Neighbour& other) {
        return is_same_place(side, row, place(other), self.plan.row_of(other.row));
      });
}

}  // namespace assembly
