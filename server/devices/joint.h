#pragma once
// Joint encoders and motors.

#include <vector>

#include "devices/tick.h"

namespace ziggurat::devices {

class Joints {
 public:
  Joints(const Setting& setting, physics::World& physics) { add(setting, physics); }

  void add(const Setting& setting, physics::World& physics);
  void start(Tick& tick) const;  ///< targets and readings that are new are 0
  void apply(Tick& tick) const;
  void sense(Tick& tick) const;

 private:
  struct Sensor {
    physics::JointIndex joint;
    bool velocity = false;
    bool disabled = false;
  };

  std::vector<physics::JointIndex> actuators_;  // parallel to Layout::joint_actuators
  std::vector<Sensor> sensors_;                 // parallel to Layout::joint_sensors
};

}  // namespace ziggurat::devices
