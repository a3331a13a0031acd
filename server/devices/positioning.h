#pragma once
// Ground truth: the pose of a robot's origin in the world, with noise where asked for.

#include <vector>

#include "devices/tick.h"
#include "math/random.h"

namespace ziggurat::devices {

class Positioning {
 public:
  explicit Positioning(const Setting& setting) { add(setting); }

  void add(const Setting& setting);
  void start(Tick& tick);  ///< senses with those that are new
  void sense(Tick& tick) { sense(tick, 0); }

 private:
  void sense(Tick& tick, std::size_t first);

  struct Sensor {
    scene::NoiseRange position, angle, axis;
    math::RandomStream random;
  };
  std::vector<Sensor> sensors_;  // parallel to Layout::positioning
};

}  // namespace ziggurat::devices
