// SPDX-License-Identifier: MIT
#include "layout.h"

namespace ziggurat {

void Layout::add_wheels() {
  auto& readings = add(Readings<Wheels::Reading>("numbers of wheels", &v1::Observation::wheels));
  auto& velocities = add(Settings<double>(&v1::Command::mutable_wheel_velocities));
  each_robot([&](const v1::RobotDescription& robot, Robot& to) {
    if (!robot.has_wheels()) return;
    const v1::WheelsDescription& from = robot.wheels();
    Wheels& wheels = to.wheels_.emplace();
    wheels.axle_length_ = from.axle_length();
    wheels.measures_ = from.measures();
    if (from.measures()) readings.add(wheels.reading_);
    if (!from.drives()) return;
    wheels.left_ = &velocities.add(0.0);
    wheels.right_ = &velocities.add(0.0);
    wheels.changed_ = &velocities.changed();
  });
}

void Wheels::set_velocity(double left, double right) {
  check_drives(drives(), "wheels");
  check_finite(left, "the speed of the left wheel");
  check_finite(right, "the speed of the right wheel");
  *left_ = left;
  *right_ = right;
  *changed_ = true;
}

}  // namespace ziggurat
