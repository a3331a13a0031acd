#include "devices/battery.h"

#include <algorithm>
#include <limits>

namespace ziggurat::devices {

Batteries::Batteries(const Setting& setting) : tick_length_(setting.tick_length) {
  for (const world::BatteryLayout& layout : setting.layout.batteries) {
    Cell cell;
    cell.battery = *setting.entities[layout.entity].devices.battery;
    cell.charge = cell.battery.start_charge;
    cells_.push_back(cell);
  }
}

world::BatteryReading Batteries::read(const Cell& cell, double used) const {
  world::BatteryReading reading;
  reading.available_charge = cell.charge / cell.battery.full_charge;
  reading.time_left =
      used > 0 ? cell.charge / used * tick_length_ : std::numeric_limits<double>::infinity();
  return reading;
}

void Batteries::start(Tick& tick) {
  tick.observations.batteries.resize(cells_.size());
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    Cell& cell = cells_[i];
    cell.pose = tick.state.origins[tick.layout.batteries[i].entity];
    tick.observations.batteries[i] = read(cell, cell.battery.per_second * tick_length_);
  }
}

void Batteries::sense(Tick& tick) {
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    Cell& cell = cells_[i];
    const math::Pose& pose = tick.state.origins[tick.layout.batteries[i].entity];
    const double moved = (pose.position - cell.pose.position).norm();
    const double turned = pose.orientation.angularDistance(cell.pose.orientation);
    const double used = cell.battery.per_second * tick_length_ + cell.battery.per_metre * moved +
                        cell.battery.per_radian * turned;
    cell.charge = std::max(0.0, cell.charge - used);
    cell.pose = pose;
    tick.observations.batteries[i] = read(cell, used);
  }
}

}  // namespace ziggurat::devices
