#include "devices/joint.h"

#include <string>

namespace ziggurat::devices {
namespace {

/// Index into Entity::joints; the reader has made sure that it is there.
std::size_t find_joint(const scene::Entity& entity, const std::string& id) {
  std::size_t joint = 0;
  while (entity.joints[joint].id != id) ++joint;
  return joint;
}

}  // namespace

void Joints::add(const Setting& setting, physics::World& physics) {
  for (const world::RobotLayout& robot : setting.new_robots()) {
    const scene::Entity& entity = setting.entity(robot.entity);
    const scene::ControllerDevices& enabled = setting.enabled(robot);
    for (const scene::JointActuator& actuator : enabled.joint_actuators) {
      actuators_.push_back(physics.joint(robot.entity, find_joint(entity, actuator.joint)));
      physics.add_motor(actuators_.back(), actuator.mode, actuator.max_impulse);
    }
    for (const scene::JointSensor& sensor : enabled.joint_sensors) {
      const std::size_t joint = find_joint(entity, sensor.joint);
      if (sensor.mode == scene::JointMode::disabled ||
          !scene::has_coordinate(entity.joints[joint].type)) {
        sensors_.push_back({{}, false, true});
      } else {
        sensors_.push_back(
            {physics.joint(robot.entity, joint), sensor.mode == scene::JointMode::velocity, false});
      }
    }
  }
}

void Joints::start(Tick& tick) const {
  tick.commands.joint_targets.resize(actuators_.size(), 0);
  tick.observations.joint_readings.resize(sensors_.size(), 0);
}

void Joints::apply(Tick& tick) const {
  for (std::size_t i = 0; i < actuators_.size(); ++i) {
    tick.physics.set_target(actuators_[i], tick.commands.joint_targets[i]);
  }
}

void Joints::sense(Tick& tick) const {
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    const Sensor& sensor = sensors_[i];
    if (sensor.disabled) continue;
    tick.observations.joint_readings[i] =
        sensor.velocity ? tick.physics.velocity(sensor.joint) : tick.physics.position(sensor.joint);
  }
}

}  // namespace ziggurat::devices
