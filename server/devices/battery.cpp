// Batteries: charge that time and motion use up. An empty one only reads 0.

#include <algorithm>
#include <limits>
#include <vector>

#include "devices/kind.h"
#include "math/archive.h"

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
    for (std::size_t i = cells_.size(); i < setting.layout.batteries.size(); ++i) {
      Cell cell;
      cell.battery = *setting.entity(setting.layout.batteries[i].entity).devices.battery;
      cell.charge = cell.battery.start_charge;
      cells_.push_back(cell);
    }
  }

  void start(Tick& tick) override {
    std::vector<world::BatteryReading>& readings = tick.observations.batteries;
    for (std::size_t i = readings.size(); i < cells_.size(); ++i) {
      Cell& cell = cells_[i];
      cell.pose = tick.state.origins[tick.layout.batteries[i].entity];
      readings.push_back(read(cell, cell.battery.per_second * tick_length_));
    }
  }

  void sense(Tick& tick) override {
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

  void archive(math::Archive& archive) override {
    for (Cell& cell : cells_) {
      archive("charge", cell.charge);
      archive("pose", cell.pose);
    }
  }

 private:
  struct Cell {
    scene::Battery battery;
    double charge = 0;  // in the battery's own unit
    math::Pose pose;    // X_WE at the last tick
  };

  world::BatteryReading read(const Cell& cell, double used) const {
    world::BatteryReading reading;
    reading.available_charge = cell.charge / cell.battery.full_charge;
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
