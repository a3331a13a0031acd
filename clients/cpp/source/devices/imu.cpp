// SPDX-License-Identifier: MIT
#include "find.h"
#include "layout.h"

namespace ziggurat {

void Layout::add_imus() {
  auto& readings = add(Readings<Imu::Reading>("numbers of IMUs", &v1::Observation::imus));
  each_robot([&](const v1::RobotDescription& robot, Robot& to) {
    to.imus_.reserve(size(robot.imus_size()));
    for (const v1::ImuDescription& from : robot.imus()) {
      Imu& imu = to.imus_.emplace_back();
      imu.id_ = from.id();
      imu.anchor_ = from.anchor();
      copy(from.position(), imu.position_);
      copy(from.orientation(), imu.orientation_);
      readings.add(imu.reading_);
    }
  });
}

const Imu& Sensors::imu(std::string_view id) const { return find(imus_, id, "the robot", "IMU"); }

}  // namespace ziggurat
