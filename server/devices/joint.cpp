// SPDX-License-Identifier: MIT
// Joint encoders and motors.

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "devices/kind.h"

namespace ziggurat::devices {
namespace {

/// Indices into Entity::joints by id. The reader has checked that those of a controller exist.
std::unordered_map<std::string_view, std::size_t> joints_of(const scene::Entity& entity) {
  std::unordered_map<std::string_view, std::size_t> joints;
  for (std::size_t i = 0; i < entity.joints.size(); ++i) joints.emplace(entity.joints[i].id, i);
  return joints;
}

/// Greatest impulse of a motor in a substep [N s] or [N m s]. @param substep  [s]
double impulse_of(const scene::JointActuator& actuator, double substep) {
  return actuator.max_force ? *actuator.max_force * substep : actuator.max_impulse;
}

class Joints final : public Kind {
 public:
  std::unique_ptr<Kind> clone() const override { return std::make_unique<Joints>(*this); }

  void lay_out(const Carrier& carrier, world::RobotLayout& robot,
               world::Layout& layout) const override {
    using scene::JointMode;
    const scene::JointsUse& joints = carrier.enabled.joints;
    robot.joint_sensors = append(joints.sensors, layout.joint_sensors, [](const auto& sensor) {
      return world::JointSensorLayout{sensor.joint, sensor.mode == JointMode::velocity,
                                      sensor.mode == JointMode::disabled};
    });
    robot.joint_actuators =
        append(joints.actuators, layout.joint_actuators, [&](const auto& actuator) {
          return world::JointActuatorLayout{actuator.joint, actuator.mode == JointMode::velocity,
                                            actuator.mode == JointMode::disabled,
                                            impulse_of(actuator, carrier.substep)};
        });
  }

  /// Adds motors to the joints that have an actuator.
  void add(const Setting& setting) override {
    for (const world::RobotLayout& robot : setting.new_robots()) {
      const scene::Entity& entity = setting.entity(robot.entity);
      const scene::JointsUse& joints = setting.enabled(robot).joints;
      if (joints.actuators.empty() && joints.sensors.empty()) continue;
      const auto by_id = joints_of(entity);
      for (const scene::JointActuator& actuator : joints.actuators) {
        actuators_.push_back(setting.physics.joint(robot.entity, by_id.at(actuator.joint)));
        setting.physics.add_motor(actuators_.back(), actuator.mode,
                                  impulse_of(actuator, setting.substep));
      }
      for (const scene::JointSensor& sensor : joints.sensors) {
        const std::size_t joint = by_id.at(sensor.joint);
        if (sensor.mode == scene::JointMode::disabled ||
            !scene::has_coordinate(entity.joints[joint].type)) {
          sensors_.push_back({.disabled = true});
        } else {
          sensors_.push_back({.joint = setting.physics.joint(robot.entity, joint),
                              .velocity = sensor.mode == scene::JointMode::velocity});
        }
      }
    }
  }

  void start(Tick& tick) override {
    tick.commands.joint_targets.resize(actuators_.size(), 0);
    tick.observations.joint_readings.resize(sensors_.size(), 0);
  }

  void apply(Tick& tick) override {
    for (std::size_t i = 0; i < actuators_.size(); ++i) {
      tick.physics.set_target(actuators_[i], tick.commands.joint_targets[i]);
    }
  }

  void sense(Tick& tick) override {
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      const Sensor& sensor = sensors_[i];
      if (sensor.disabled) continue;
      tick.observations.joint_readings[i] = sensor.velocity ? tick.physics.velocity(sensor.joint)
                                                            : tick.physics.position(sensor.joint);
    }
  }

 private:
  struct Sensor {
    physics::JointIndex joint = {};
    bool velocity = false;
    bool disabled = false;
  };

  std::vector<physics::JointIndex> actuators_;  // parallel to Layout::joint_actuators
  std::vector<Sensor> sensors_;                 // parallel to Layout::joint_sensors
};

}  // namespace

std::unique_ptr<Kind> make_joints() { return std::make_unique<Joints>(); }

}  // namespace ziggurat::devices
