// SPDX-License-Identifier: MIT
#pragma once
// A robot without a server: the test sets what it senses and sees what it is commanded.

#include "fleet.h"

namespace ziggurat {

class OneRobot {
 public:
  explicit OneRobot(const v1::RobotDescription& description) : fleet_(welcome(description)) {
    const auto count_of = [&](auto has) {
      int count = 0;
      for (const auto& camera : description.cameras()) count += (camera.*has)() ? 1 : 0;
      return count;
    };
    seen.mutable_joint_readings()->Resize(description.joint_sensors_size(), 0);
    seen.mutable_proximity()->Resize(description.proximity_sensors_size(), 0);
    if (description.positioning()) seen.mutable_positioning()->Resize(7, 0);
    seen.mutable_contact_sensors()->Resize(5 * description.contact_sensors_size(), 0);
    seen.mutable_imus()->Resize(6 * description.imus_size(), 0);
    if (description.battery()) seen.mutable_batteries()->Resize(2, 0);
    if (description.wheels().measures()) seen.mutable_wheels()->Resize(4, 0);
    if (description.turret().measures()) seen.mutable_turret_rotations()->Resize(1, 0);
    for (const v1::DeviceKind& kind : description.device_kinds()) {
      if (kind.most_rows() > 0) {
        seen.mutable_device_rows()->Resize(seen.device_rows_size() + kind.devices_size(), 0);
      } else {
        seen.mutable_device_readings()->Resize(
            seen.device_readings_size() + kind.readings_size() * kind.devices_size(), 0);
      }
    }
    seen.mutable_led_counts()->Resize(count_of(&v1::CameraDescription::detects_leds), 0);
    seen.mutable_directional_led_counts()->Resize(
        count_of(&v1::CameraDescription::detects_directional_leds), 0);
    seen.mutable_tag_counts()->Resize(count_of(&v1::CameraDescription::detects_tags), 0);
    for (int i = count_of(&v1::CameraDescription::image); i > 0; --i) seen.add_camera_images();
  }

  Robot& robot() { return fleet_.robots()[0]; }

  v1::Observation seen;  ///< initially zeros, without camera readings, messages and packets
  void sense() { fleet_.read(seen); }

  /// Values that were set since the last call.
  v1::Command command() {
    v1::Command command;
    fleet_.write(command);
    fleet_.sent();
    return command;
  }

 private:
  static v1::Welcome welcome(const v1::RobotDescription& description) {
    v1::Welcome welcome;
    welcome.mutable_version()->set_major(1);
    welcome.set_max_message_bytes(64 << 20);
    *welcome.add_robots() = description;
    return welcome;
  }

  Fleet fleet_;
};

}  // namespace ziggurat
