#include "simulation/layout.h"

#include "simulation/device_layout.h"

namespace ziggurat::simulation {
namespace {

void add_joints(const scene::ControllerDevices& enabled, world::RobotLayout& robot,
                world::Layout& layout) {
  robot.joint_sensors = {layout.joint_sensors.size(), enabled.joint_sensors.size()};
  for (const scene::JointSensor& sensor : enabled.joint_sensors) {
    layout.joint_sensors.push_back({sensor.joint, sensor.mode == scene::JointMode::velocity,
                                    sensor.mode == scene::JointMode::disabled});
  }
  robot.joint_actuators = {layout.joint_actuators.size(), enabled.joint_actuators.size()};
  for (const scene::JointActuator& actuator : enabled.joint_actuators) {
    layout.joint_actuators.push_back({actuator.joint, actuator.mode == scene::JointMode::velocity,
                                      actuator.mode == scene::JointMode::disabled,
                                      actuator.max_impulse});
  }
}

}  // namespace

void append(const scene::Scene& scene, const scene::Entity& entity, world::Layout& layout) {
  const std::size_t index = layout.entities.size();
  const bool single = scene::is_single(entity.kind);
  layout.entities.push_back({entity.id, {layout.links.size(), entity.links.size()}, !single});
  for (const scene::Link& link : entity.links) {
    layout.links.push_back({single ? "" : link.id, index});
  }
  const scene::Controller* controller =
      entity.controller ? &scene.controllers[*entity.controller] : nullptr;
  const scene::ControllerDevices nothing;
  world::RobotLayout robot;
  add_devices({entity, index, controller ? controller->devices : nothing}, robot, layout);
  if (!controller) return;
  robot.id = entity.id;
  robot.entity = index;
  robot.controller = *entity.controller;
  robot.params = entity.overrides_params ? entity.params : controller->params;
  add_joints(controller->devices, robot, layout);
  layout.robots.push_back(std::move(robot));
}

world::Layout make_layout(const scene::Scene& scene, const std::vector<scene::Entity>& entities) {
  world::Layout layout;
  for (const scene::Entity& entity : entities) append(scene, entity, layout);
  return layout;
}

}  // namespace ziggurat::simulation
