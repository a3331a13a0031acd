#pragma once
// Ground truth: the pose of a robot's origin in the world, with noise where asked for.

#include <vector>

#include "devices/tick.h"
#include "math/random.h"

namespace ziggurat::devices {

class Positioning {
 public:
  explicit Positioning(const Setting& setting);

  void sense(Tick& tick);

 private:
  struct Sensor {
    scene::NoiseRange position, angle, axis;
    math::RandomStream random;
  };
  std::vector<Sensor> sensors_;  // parallel to Layout::positioning
};

}  // namespace ziggurat::devices
