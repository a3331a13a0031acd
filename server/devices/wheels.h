#pragma once
// Two driven wheels: speeds that are commanded, and what an encoder makes of them.

#include <array>
#include <vector>

#include "devices/tick.h"
#include "math/random.h"

namespace ziggurat::devices {

class Wheels {
 public:
  explicit Wheels(const Setting& setting) : tick_length_(setting.tick_length) { add(setting); }

  void add(const Setting& setting);
  void start(Tick& tick) const;  ///< commands and readings that are new are 0
  void apply(Tick& tick);
  void sense(Tick& tick);

 private:
  struct Axle {
    std::array<scene::WheelNoise, 2> noise;  // left, right
    scene::NoiseRange velocity_noise, distance_noise;
    math::RandomStream driving, measuring;
    std::array<double, 2> bias{};      // [m/s]
    std::array<double, 2> velocity{};  // of the wheels in this tick [m/s]
  };

  double tick_length_;       // [s]
  std::vector<Axle> axles_;  // parallel to Layout::wheels
};

}  // namespace ziggurat::devices
