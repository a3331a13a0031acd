// SPDX-License-Identifier: MIT
// A lift: a prismatic joint that a motor holds at a height.

#include <cstddef>
#include <vector>

#include "devices/described.h"

namespace ziggurat::devices {
namespace {

constexpr world::DeviceKind lift_system{.name = "lift_system",
                                        .readings = {{"position", "m"}, {"velocity", "m/s"}},
                                        .commands = {{"position", "m", 0, 1}}};

class LiftSystem final : public Described {
 public:
  LiftSystem() : Described(lift_system) {}
  std::unique_ptr<Kind> clone() const override { return std::make_unique<LiftSystem>(*this); }

 private:
  /// Settings of a place: the joint's index in its entity, and the motor's force [N].
  void add_robot(const Setting& setting) override {
    const Robot& robot = robots().back();
    const std::size_t entity = setting.layout.robots[robot.index].entity;
    const auto& settings = robot.places[0].settings;
    joints_.push_back(setting.physics.joint(entity, static_cast<std::size_t>(settings[0])));
    if (!robot.use.actuator) return;
    setting.physics.add_motor(joints_.back(), scene::JointMode::position,
                              settings[1] * setting.substep);
  }

  void act(Tick& tick, std::size_t number, std::size_t /*entity*/,
           std::span<const double> commands) override {
    tick.physics.set_target(joints_[number], commands[0]);
  }

  void read(Tick& tick, Robot& robot) override {
    const physics::JointIndex joint = joints_[static_cast<std::size_t>(&robot - robots().data())];
    double* const readings =
        &tick.observations
             .device_readings[tick.layout.described[robot.devices.begin].readings.begin];
    readings[0] = tick.physics.position(joint);
    readings[1] = tick.physics.velocity(joint);
  }

  std::vector<physics::JointIndex> joints_;  // of each robot
};

}  // namespace

std::unique_ptr<Kind> make_lift_system() { return std::make_unique<LiftSystem>(); }

}  // namespace ziggurat::devices
