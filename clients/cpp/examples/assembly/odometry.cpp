// SPDX-License-Identifier: MIT
#include "odometry.h"

#include <algorithm>
#include <cmath>

namespace assembly {

void reckon(Odometry& odometry, const construction::Builder& builder, const ziggurat::Imu& imu) {
  Pose& pose = odometry.pose;
  const double way = builder.speed() * construction::tick;
  const double turned = imu.angular_velocity()[2] * construction::tick;
  const double aside = -odometry.pivot[builder.loaded] * turned;
  const double c = std::cos(pose.yaw + turned / 2), s = std::sin(pose.yaw + turned / 2);
  pose.x = pose.x + way * c - aside * s;
  pose.y = pose.y + way * s + aside * c;
  pose.yaw = pose.yaw + turned;
  odometry.turned = turned;
}

double pivot_ahead(const Odometry& odometry, bool loaded) { return odometry.pivot[loaded]; }

Pose pivot_of(const Odometry& odometry, bool loaded) {
  return {ahead_of(odometry.pose, odometry.pivot[loaded]), odometry.pose.yaw};
}

void learn(Odometry& odometry, bool loaded, const Point& off) {
  if (std::abs(odometry.turned) < 0.015) return;
  const double yaw = odometry.pose.yaw;
  const double aside = -off.x * std::sin(yaw) + off.y * std::cos(yaw);
  const double change = std::clamp(aside / odometry.turned, -0.01, 0.01);
  double& pivot = odometry.pivot[loaded];
  pivot = std::clamp(pivot + 0.2 * change, 0.0, 0.04);
}

}  // namespace assembly
