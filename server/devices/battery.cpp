#include "devices/battery.h"

#include <algorithm>
#include <limits>

namespace ziggurat::devices {

void Batteries::add(const Setting& setting) {
  for (std::size_t i = cells_.size(); i < setting.layout.batteries.size(); ++i) {
    Cell cell;
    cell.battery = *setting.entity(setting.layout.batteries[i].entity).devices.battery;
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
  std::vector<world::BatteryReading>& readings = tick.observations.batteries;
  for (std::size_t i = readings.size(); i < cells_.size(); ++i) {
    Cell& cell = cells_[i];
    cell.pose = tick.state.origins[tick.layout.batteries[i].entity];
    readings.push_back(read(cell, cell.battery.per_second * tick_length_));
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
