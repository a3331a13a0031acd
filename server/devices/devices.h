#pragma once
// All kinds of devices, in the order in which they act and sense. To add one, write its file and
// its lines here and in devices.cpp; docs/adding-a-device.md has the whole walk.

#include "devices/battery.h"
#include "devices/camera.h"
#include "devices/joint.h"
#include "devices/picture.h"
#include "devices/positioning.h"
#include "devices/proximity.h"
#include "devices/radio.h"
#include "devices/range_and_bearing.h"
#include "devices/tick.h"
#include "devices/turret.h"
#include "devices/visible.h"
#include "devices/wheels.h"

namespace ziggurat::devices {

class Devices {
 public:
  /// Adds motors to the joints that have an actuator.
  Devices(const Setting& setting, physics::World& physics);

  /// Takes in those of robots that have come since.
  void add(const Setting& setting, physics::World& physics);

  /// Gives commands and observations their length, those that are new their initial values, and
  /// State what is visible of them. Their first poses are due. What others command and show stays.
  void start(Tick& tick);

  /// Before physics: what was commanded takes effect, at the poses of the last tick.
  void apply(Tick& tick);

  /// After physics, with rays and index at the new poses.
  void sense(Tick& tick);

  bool casts_rays() const {
    return proximity_.casts_rays() || range_and_bearing_.casts_rays() || cameras_.detects();
  }
  bool needs_index() const {
    return radios_.needs_index() || range_and_bearing_.needs_index() || cameras_.detects();
  }

 private:
  Joints joints_;
  Wheels wheels_;
  Turrets turrets_;
  Radios radios_;
  Proximity proximity_;
  RangeAndBearing range_and_bearing_;
  Positioning positioning_;
  Batteries batteries_;
  Cameras cameras_;
  Pictures pictures_;
};

}  // namespace ziggurat::devices
