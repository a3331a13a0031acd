// SPDX-License-Identifier: MIT
#include "find.h"
#include "layout.h"

namespace ziggurat {

void Layout::add_contact_sensors() {
  auto& readings = add(Readings<ContactSensor::Reading>("numbers of contact sensors",
                                                        &v1::Observation::contact_sensors));
  each_robot([&](const v1::RobotDescription& robot, Robot& to) {
    to.contact_sensors_.reserve(size(robot.contact_sensors_size()));
    for (const v1::ContactSensorDescription& from : robot.contact_sensors()) {
      ContactSensor& sensor = to.contact_sensors_.emplace_back();
      sensor.id_ = from.id();
      sensor.anchor_ = from.anchor();
      readings.add(sensor.reading_);
    }
  });
}

const ContactSensor& Sensors::contact_sensor(std::string_view id) const {
  return find(contact_sensors_, id, "the robot", "contact sensor");
}

}  // namespace ziggurat
