// SPDX-License-Identifier: MIT
#include "layout.h"

namespace ziggurat {

void Layout::add_proximity_sensors() {
  auto& readings = add(Readings<double>("proximity readings", &v1::Observation::proximity));
  each_robot([&](const v1::RobotDescription& robot, Robot& to) {
    to.proximity_.reserve(size(robot.proximity_sensors_size()));
    for (const v1::ProximityDescription& from : robot.proximity_sensors()) {
      ProximitySensor& sensor = to.proximity_.emplace_back();
      sensor.anchor_ = from.anchor();
      copy(from.position(), sensor.position_);
      copy(from.direction(), sensor.direction_);
      sensor.range_ = from.range();
      if (from.has_angle()) sensor.angle_ = from.angle();
      readings.add(sensor.reading_);
    }
  });
}

}  // namespace ziggurat
