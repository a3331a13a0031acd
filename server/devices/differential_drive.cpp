// SPDX-License-Identifier: MIT
// Differential drive of robots whose scripts give its speeds in metres per second.

#include <array>
#include <cstdint>
#include <vector>

#include "devices/described.h"
#include "math/archive.h"

namespace ziggurat::devices {
namespace {

/// Readings are the speeds at which the two wheels ran in the tick.
constexpr world::DeviceKind differential_drive{.name = "differential_drive",
                                               .readings = {{"left", "m/s"}, {"right", "m/s"}},
                                               .commands = {{"left", "m/s"}, {"right", "m/s"}}};

class DifferentialDrive final : public Described {
 public:
  DifferentialDrive() : Described(differential_drive) {}
  std::unique_ptr<Kind> clone() const override {
    return std::make_unique<DifferentialDrive>(*this);
  }

  void archive(math::Archive& archive) override {
    Described::archive(archive);
    for (Speeds& speeds : speeds_) archive("speeds", speeds);
  }

 private:
  using Speeds = std::array<double, 2>;  // speeds, left and right [m/s]

  void add_robot(const Setting&) override { speeds_.push_back({}); }

  void act(Tick& tick, std::size_t number, std::size_t entity,
           std::span<const double> commands) override {
    const double left = commands[0], right = commands[1];
    speeds_[number] = {left, right};
    tick.physics.set_velocity(entity, (left + right) / 2,
                              (right - left) / robots()[number].places[0].settings[0]);
  }

  void read(Tick& tick, Robot& robot) override {
    const Speeds& speeds = speeds_[static_cast<std::size_t>(&robot - robots().data())];
    const world::Range& readings = tick.layout.described[robot.devices.begin].readings;
    for (std::size_t i = 0; i < speeds.size(); ++i)
      tick.observations.device_readings[readings.begin + i] = speeds[i];
  }

  std::vector<Speeds> speeds_;  // of each robot
};

}  // namespace

std::unique_ptr<Kind> make_differential_drive() { return std::make_unique<DifferentialDrive>(); }

}  // namespace ziggurat::devices
