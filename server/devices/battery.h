#pragma once
// Batteries: charge that time and motion use up. An empty one only reads 0.

#include <vector>

#include "devices/tick.h"

namespace ziggurat::devices {

class Batteries {
 public:
  explicit Batteries(const Setting& setting) : tick_length_(setting.tick_length) { add(setting); }

  void add(const Setting& setting);
  void start(Tick& tick);  ///< those that are new
  void sense(Tick& tick);

 private:
  struct Cell {
    scene::Battery battery;
    double charge = 0;  // in the battery's own unit
    math::Pose pose;    // X_WE at the last tick
  };

  world::BatteryReading read(const Cell& cell, double used) const;

  double tick_length_;       // [s]
  std::vector<Cell> cells_;  // parallel to Layout::batteries
};

}  // namespace ziggurat::devices
