// SPDX-License-Identifier: MIT
#pragma once
// Reading one device of a controller's <actuators> or <sensors>, for the functions in the table of
// controller_devices.cpp.

#include "scene/draft.h"

namespace ziggurat::scene {

/// Arguments to read one device.
struct Enabling {
  Draft& draft;
  Element& element;
  ControllerDevices& devices;
  ControllerUse& use;
  DescribedUse* described = nullptr;  ///< of a device that describes itself
};

void enable_joint_actuators(const Enabling& enabling);
/// A joint may have a sensor of its position and one of its velocity.
void enable_joint_sensors(const Enabling& enabling);

// Devices of robots that come as they are.

/// LEDs whose medium may be left out: it is the first one of LEDs then.
void enable_leds_of_robot(const Enabling& enabling);
/// Messages whose medium may be left out: robots without one hear each other.
void enable_kilobot_communication(const Enabling& enabling);
/// An IMU "imu" at the robot's origin.
void enable_imu_of_robot(const Enabling& enabling);
/// The camera of a builderbot, with the detectors whose medium the scene has.
void enable_builderbot_camera(const Enabling& enabling);

}  // namespace ziggurat::scene
