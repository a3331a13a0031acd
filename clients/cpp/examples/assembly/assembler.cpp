// SPDX-License-Identifier: MIT
#include "assembler.h"

#include <algorithm>
#include <cmath>

namespace assembly {

State decide(const Assembler& self) {
  return self.builder.loaded ? State::choose_side : State::choose_block;
}

double distance_to(const Assembler& self, const Point& place) {
  return distance_between(place, self.odometry.pose);
}

Point middle(const Assembler& self) { return middle_of(self.memory).value_or(Point{}); }

double distance_from_middle(const Assembler& self, const Point& place) {
  return distance_between(place, middle(self));
}

double direction_to(const Assembler& self, const Point& place) {
  return std::atan2(place.y - self.odometry.pose.y, place.x - self.odometry.pose.x);
}

construction::Face face_of(const Assembler& self, const Pose& side) {
  const Pose& pose = self.odometry.pose;
  const double c = std::cos(pose.yaw), s = std::sin(pose.yaw);
  const double dx = side.x - pose.x, dy = side.y - pose.y;
  construction::Face face;
  face.forward = c * dx + s * dy;
  face.left = -s * dx + c * dy;
  face.heading = wrapped(side.yaw + pi - pose.yaw);
  return face;
}

bool is_taken(const Assembler& self, const Point& place, double reach) {
  return std::ranges::any_of(self.traffic.neighbours, [&](const Neighbour& other) {
    const double distance = distance_between(place_of(other, self.odometry.pose), place);
    return distance < reach && distance < distance_to(self, place);
  });
}

double hindrance(const Pose& side, const std::vector<Point>& obstacles) {
  double sum = 0;
  for (const Point& obstacle : obstacles) {
    const double dx = obstacle.x - side.x, dy = obstacle.y - side.y;
    const double out = dx * std::cos(side.yaw) + dy * std::sin(side.yaw);
    const double aside = std::abs(dy * std::cos(side.yaw) - dx * std::sin(side.yaw));
    if (out > 0.04 && out < 0.42 && aside < 0.14) sum = sum + 1;
  }
  return sum;
}

std::vector<Viewpoint> ring(Assembler& self, double radius, int count) {
  const Point centre = middle(self);
  const Pose& pose = self.odometry.pose;
  const double first = std::atan2(pose.y - centre.y, pose.x - centre.x);
  const int sign = self.random.bernoulli() ? 1 : -1;
  std::vector<Viewpoint> points;
  for (int n = 0; n < count; ++n) {
    points.push_back(
        {.angle = first + sign * n * 2 * pi / count, .radius = radius + extent_of(self.memory)});
  }
  return points;
}

Point place_of(const Assembler& self, const Viewpoint& point) {
  return ahead_of({middle(self), point.angle}, point.radius);
}

std::optional<bool> drive_back(Assembler& self, double seconds, int most) {
  if (is_blocked(self.traffic, -1) && self.job.seconds() < 15) {
    self.builder.stop();
    return std::nullopt;
  }
  self.builder.drive(-0.05, 0);
  if (self.job.seconds() <= seconds) return std::nullopt;
  ++self.job.tries;
  return self.job.tries <= most;
}

}  // namespace assembly
