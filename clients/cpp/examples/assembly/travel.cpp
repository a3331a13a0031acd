// SPDX-License-Identifier: MIT
#include "travel.h"

#include <algorithm>
#include <cmath>

#include "assembler.h"

namespace assembly {
namespace {

constexpr double fastest = 0.18;  // [m/s]
constexpr double turn_rate = 1;   // [rad/s]
// In front of the robot's centre: so near it drives up to nothing unknown [m].
constexpr double near = 0.1;

const Pose& pose_of(const Assembler& self) { return self.odometry.pose; }

void plan_way(Assembler& self) {
  Travel& travel = self.travel;
  std::vector<Obstacle> list;
  add_obstacles(self.memory, list);
  add_obstacles(self.traffic, pose_of(self), list);
  std::erase_if(travel.bumps, [&](const Bump& bump) { return self.memory.now - bump.seen > 300; });
  std::for_each(travel.bumps.rbegin(), travel.bumps.rend(),
                [&](const Bump& bump) { list.push_back(bump.obstacle); });
  travel.points = find_path(pose_of(self), *travel.goal, list);
  travel.planned = self.memory.now;
}

/// Whether a remembered block is so near in front of the robot that driving on would push it.
bool is_column_ahead(const Assembler& self) {
  const Pose& here = pose_of(self);
  const double c = std::cos(here.yaw), s = std::sin(here.yaw);
  std::vector<Obstacle> obstacles;
  add_obstacles(self.memory, obstacles);
  return std::ranges::any_of(obstacles, [&](const Obstacle& thing) {
    const double dx = thing.x - here.x, dy = thing.y - here.y;
    const double forward = c * dx + s * dy, left = -s * dx + c * dy;
    const bool is_single = thing.hard < 0.15;  // the arm passes over it
    const double front = is_single ? 0.03 : 0.1, reach = is_single ? 0.108 : 0.11;
    return forward > 0 && is_within({forward, left}, {front, 0}, reach);
  });
}

/// Whether another robot stands at the goal, nearer than this one.
bool is_occupied(const Assembler& self, double own_distance) {
  return std::ranges::any_of(self.traffic.neighbours, [&](const Neighbour& other) {
    const double distance = distance_between(place_of(other, pose_of(self)), *self.travel.goal);
    return distance < std::min(0.27, own_distance);
  });
}

/// Drives or turns, if no robot and no block is in the way. False if one is.
bool move(Assembler& self, double wanted, double turn) {
  double& speed = self.travel.speed;
  self.traffic.stopped = wanted != 0 && is_blocked(self.traffic, wanted);
  if (self.traffic.stopped || (wanted > 0 && is_column_ahead(self))) {
    speed = 0;
    self.builder.stop();
    return false;
  }
  speed = std::max(speed - 0.03, std::min(speed + 0.015, wanted));
  self.builder.drive(speed, turn);
  return true;
}

bool is_rear_free(const Assembler& self) {
  const construction::Builder& builder = self.builder;
  return std::min({builder.distance(6), builder.distance(7), builder.distance(8)}) > 0.03;
}

/// Moves straight for some ticks, out of somebody's way.
void evade(Assembler& self, int direction, int ticks) {
  if (direction < 0 && !is_rear_free(self)) direction = 1;
  self.travel.evading_ticks = ticks;
  self.travel.evading_speed = 0.05 * direction;
}

/// Goes on with that; true while it does.
bool evades(Assembler& self) {
  Travel& travel = self.travel;
  if (travel.evading_ticks <= 0) return false;
  --travel.evading_ticks;
  const double speed = travel.evading_speed;
  const bool is_obstructed =
      (speed > 0 && self.builder.ahead() < near) || (speed < 0 && !is_rear_free(self));
  if (is_obstructed || !move(self, speed, 0)) {
    self.builder.stop();
    travel.evading_ticks = 0;
  }
  if (travel.evading_ticks == 0) travel.points.reset();
  return true;
}

/// Distance to a column in front that the robot would touch when it turns [m].
std::optional<double> column_beside(const Assembler& self) {
  const Pose& here = pose_of(self);
  for (const auto& [key, column] : self.memory.columns) {
    const double dx = column->x - here.x, dy = column->y - here.y;
    if (dx * dx + dy * dy < squared(0.16)) return dx * std::cos(here.yaw) + dy * std::sin(here.yaw);
  }
  return std::nullopt;
}

/// Distance to a dark block in front that the robot would touch when it turns on the spot [m].
std::optional<double> block_beside(const Assembler& self) {
  const Pose pivot = pivot_of(self.odometry, self.builder.loaded);
  for (const auto& block : self.memory.material) {
    const double dx = block->x - pivot.x, dy = block->y - pivot.y;
    if (dx * dx + dy * dy < squared(0.145)) {
      return dx * std::cos(pivot.yaw) + dy * std::sin(pivot.yaw);
    }
  }
  return std::nullopt;
}

/// Before a turn on the spot: drives straight away from a block that is in the way; true while it
/// does. It does not try again for some time.
bool make_room(Assembler& self) {
  if (self.memory.now < self.travel.made_room_at + 40) return false;
  const std::optional<double> forward = block_beside(self);
  if (!forward) return false;
  self.travel.made_room_at = self.memory.now;
  evade(self, *forward > 0 ? -1 : 1, 15);
  return true;
}

/// Drives straight away from a robot or a column that is very near; true while it does.
bool keep_distance(Assembler& self) {
  if (self.travel.evading_ticks <= 0 && !self.traffic.working) {
    const Neighbour* other = nearest(self.traffic);
    const bool is_near =
        other &&
        (other->range < 0.27 || (other->stopped && self.travel.speed == 0 && other->range < 0.4));
    const std::optional<double> forward = is_near ? other->forward : column_beside(self);
    if (forward) evade(self, *forward > 0 ? -1 : 1, 15);
  }
  return evades(self);
}

/// Drives along the way, which is known.
/// @param pivot     the point about which the robot turns
/// @param distance  of the goal from there [m]
void follow(Assembler& self, const Pose& pivot, double distance) {
  Travel& travel = self.travel;
  std::vector<Point>& points = *travel.points;
  while (points.size() > 1 && is_within(points.front(), pivot, 0.09)) {
    points.erase(points.begin());
  }
  const Point& next = points.front();
  const double bearing = wrapped(std::atan2(next.y - pivot.y, next.x - pivot.x) - pivot.yaw);
  const double turn = std::clamp(1.8 * bearing, -turn_rate, turn_rate);
  if (std::abs(bearing) > 0.45) {
    if (make_room(self)) return;
    travel.speed = 0;
    self.builder.drive(0, turn);
    return;
  }
  if (self.builder.ahead() < near) {
    travel.bumps.push_back({{ahead_of(pivot, 0.13), 0.13, 0.18}, self.memory.now});
    evade(self, -1, 20);
    return;
  }
  const double wanted = std::min(fastest, std::max(0.02, distance)) * (1 - std::abs(bearing));
  if (move(self, wanted, turn)) {
    travel.blocked = 0;
    return;
  }
  if (++travel.blocked <= travel.patience) return;
  travel.blocked = 0;
  travel.patience = static_cast<int>(self.random.uniform_int(10, 40));
  travel.points.reset();
  if (is_column_ahead(self) || self.random.bernoulli()) evade(self, -1, 15);
}

}  // namespace

Arrival travel_to(Assembler& self, const Point& goal) {
  Travel& travel = self.travel;
  const std::int64_t now = self.memory.now;
  const Pose pivot = pivot_of(self.odometry, self.builder.loaded);
  const double distance = distance_between(goal, pivot);
  if (!travel.goal ||
      !(squared(travel.goal->x - goal.x) + squared(travel.goal->y - goal.y) <= squared(0.03))) {
    travel.points.reset();
    travel.least_distance.reset();
  }
  travel.goal = goal;
  if (!travel.least_distance || distance < *travel.least_distance - 0.03) {
    travel.least_distance = distance;
    travel.least_at = now;
  }
  const bool has_arrived = distance < 0.015;
  if (has_arrived || now - travel.least_at > 250) {
    self.builder.stop();
    forget(travel);
    return has_arrived ? Arrival::there : Arrival::stuck;
  }
  if (keep_distance(self)) return Arrival::under_way;
  const Neighbour* other = nearest(self.traffic);
  const std::int64_t age = travel.points ? now - travel.planned : never;
  if (age > 50 || (other && other->range < 0.7 && age > 12)) plan_way(self);
  if (!travel.points || (distance < 0.5 && is_occupied(self, distance))) {
    self.builder.stop();
    return ++travel.waited > 20 ? Arrival::occupied : Arrival::under_way;
  }
  travel.waited = 0;
  follow(self, pivot, distance);
  return Arrival::under_way;
}

bool turn_to(Assembler& self, double yaw) {
  if (keep_distance(self)) return false;
  const double error = wrapped(yaw - pose_of(self).yaw);
  if (std::abs(error) < 0.03) {
    self.builder.stop();
    return true;
  }
  if (std::abs(error) > 0.45 && make_room(self)) return false;
  self.builder.drive(0, std::clamp(2 * error, -turn_rate, turn_rate) + (error > 0 ? 0.03 : -0.03));
  return false;
}

void wait(Assembler& self) {
  if (!keep_distance(self)) self.builder.stop();
}

void spin(Assembler& self, double rate) {
  if (!keep_distance(self) && !make_room(self)) self.builder.drive(0, rate);
}

void forget(Travel& travel) {
  travel.goal.reset();
  travel.points.reset();
  travel.least_distance.reset();
  travel.speed = 0;
  travel.blocked = 0;
  travel.waited = 0;
}

}  // namespace assembly
