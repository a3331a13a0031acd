#include "wire/description.h"

#include "ziggurat/v1/envelope.h"

namespace ziggurat::wire {
namespace {

v1::JointDescription::Mode mode_of(bool disabled, bool velocity) {
  if (disabled) return v1::JointDescription::DISABLED;
  return velocity ? v1::JointDescription::VELOCITY : v1::JointDescription::POSITION;
}

}  // namespace

void describe(const Run& run, std::size_t robot, v1::RobotDescription& description) {
  const world::RobotLayout& layout = run.layout.robots[robot];
  description.set_id(v1::valid_utf8(layout.id));
  description.set_controller(v1::valid_utf8(run.controllers[layout.controller].id));
  for (const auto& [name, value] : layout.params) {
    v1::Parameter& parameter = *description.add_params();
    parameter.set_name(v1::valid_utf8(name));
    parameter.set_value(v1::valid_utf8(value));
  }
  if (robot < run.scripts.size()) description.set_script(v1::valid_utf8(run.scripts[robot]));
  for (std::size_t i = layout.joint_sensors.begin; i < layout.joint_sensors.end(); ++i) {
    const world::JointSensorLayout& sensor = run.layout.joint_sensors[i];
    v1::JointDescription& joint = *description.add_joint_sensors();
    joint.set_id(v1::valid_utf8(sensor.id));
    joint.set_mode(mode_of(sensor.disabled, sensor.velocity));
  }
  for (std::size_t i = layout.joint_actuators.begin; i < layout.joint_actuators.end(); ++i) {
    const world::JointActuatorLayout& actuator = run.layout.joint_actuators[i];
    v1::JointDescription& joint = *description.add_joint_actuators();
    joint.set_id(v1::valid_utf8(actuator.id));
    joint.set_mode(mode_of(actuator.disabled, actuator.velocity));
    joint.set_max_impulse(actuator.max_impulse);
  }
}

}  // namespace ziggurat::wire
