// SPDX-License-Identifier: MIT
// Grippers: at the front of a robot's turret, they hold what they touch with a limited force.

#include <vector>

#include "devices/described.h"

namespace ziggurat::devices {
namespace {

constexpr world::DeviceKind gripper{
    .name = "gripper", .readings = {{"gripped"}}, .commands = {{"lock", "", 0, 1}}};
class Grippers final : public Described {
 public:
  Grippers() : Described(gripper) {}
  std::unique_ptr<Kind> clone() const override { return std::make_unique<Grippers>(*this); }

 private:
  static physics::Gripper of(const Robot& robot) {
    const scene::DevicePlace& place = robot.places[0];
    return {.distance = place.pose.position.x(),
            .radius = place.settings[0],
            .height = place.settings[1],
            .max_force = robot.use.strength};
  }

  /// A locked gripper holds what it touches first; one whose grip tore must be unlocked before.
  void act(Tick& tick, std::size_t number, std::size_t entity,
           std::span<const double> commands) override {
    if (commands[0] > 0.5) {
      tick.physics.grip(entity, of(robots()[number]));
    } else {
      tick.physics.release(entity);
    }
  }

  void read(Tick& tick, Robot& robot) override {
    const world::DescribedDevice& device = tick.layout.described[robot.devices.begin];
    const bool holds = tick.physics.holds(tick.layout.robots[robot.index].entity);
    tick.observations.device_readings[device.readings.begin] = holds ? 1 : 0;
  }
};

}  // namespace

std::unique_ptr<Kind> make_gripper() { return std::make_unique<Grippers>(); }

}  // namespace ziggurat::devices
