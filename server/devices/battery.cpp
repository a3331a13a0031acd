// SPDX-License-Identifier: MIT
// Batteries: charge that time and motion use up. An empty one only reads 0.

#include <algorithm>
#include <limits>
#include <vector>

#include "devices/kind.h"
#include "math/archive.h"
#include "math/random.h"

namespace ziggurat::devices {
namespace {

class Batteries final : public Kind {
 public:
  std::unique_ptr<Kind> clone() const override { return std::make_unique<Batteries>(*this); }

  void lay_out(const Carrier& carrier, world::RobotLayout& robot,
               world::Layout& layout) const override {
    const bool enabled = carrier.enabled.battery && carrier.entity.devices.battery;
    robot.batteries = append_if(enabled, layout.batteries, world::BatteryLayout{carrier.index});
  }

  void add(const Setting& setting) override {
    tick_length_ = setting.tick_length;
    for (const world::RobotLayout& robot : setting.new_robots()) {
      if (robot.batteries.count == 0) continue;
      const scene::Battery& battery = *setting.entity(robot.entity).devices.battery;
      cells_.push_back({battery,
                        *setting.enabled(robot).battery,
                        battery.start_charge,
                        {},
                        math::RandomStream(setting.seed, "battery/" + robot.id)});
    }
  }

  void start(Tick& tick) override {
    std::vector<world::BatteryReading>& readings = tick.observations.batteries;
    for (std::size_t i = readings.size(); i < cells_.size(); ++i) {
      Cell& cell = cells_[i];
      cell.pose = tick.state.origins[tick.layout.batteries[i].entity];
      readings.push_back(read(cell, cell.battery.per_tick));
    }
  }

  void sense(Tick& tick) override {
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      Cell& cell = cells_[i];
      const math::Pose& pose = tick.state.origins[tick.layout.batteries[i].entity];
      const double moved = (pose.position - cell.pose.position).norm();
      const double turned = pose.orientation.angularDistance(cell.pose.orientation);
      const double used =
          cell.battery.per_tick + cell.battery.per_metre * moved + cell.battery.per_radian * turned;
      cell.charge = std::max(0.0, cell.charge - used);
      cell.pose = pose;
      tick.observations.batteries[i] = read(cell, used);
    }
  }

  void archive(math::Archive& archive) override {
    for (Cell& cell : cells_) {
      archive("charge", cell.charge);
      archive("pose", cell.pose);
      archive("random", cell.random);
    }
  }

 private:
  struct Cell {
    scene::Battery battery;
    scene::BatteryUse noise;
    double charge = 0;  // in the battery's own unit
    math::Pose pose;    // X_WE at the last tick
    math::RandomStream random;
  };

  world::BatteryReading read(Cell& cell, double used) const {
    world::BatteryReading reading;
    const auto& [least, most] = cell.noise.charge;
    reading.available_charge = std::clamp(
        cell.charge / cell.battery.full_charge + cell.random.uniform(least, most), 0.0, 1.0);
    reading.time_left =
        used > 0 ? cell.charge / used * tick_length_ : std::numeric_limits<double>::infinity();
    return reading;
  }

  double tick_length_ = 0;   // [s]
  std::vector<Cell> cells_;  // parallel to Layout::batteries
};

}  // namespace

std::unique_ptr<Kind> make_batteries() { return std::make_unique<Batteries>(); }

}  // namespace ziggurat::devices
