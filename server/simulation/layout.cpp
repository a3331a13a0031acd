#include "simulation/layout.h"

namespace ziggurat::simulation {
namespace {

void add_robot(const scene::Scene& scene, const scene::Entity& entity, std::size_t index,
               world::Layout& layout) {
  const scene::Controller& controller = scene.controllers[*entity.controller];
  world::RobotLayout robot;
  robot.id = entity.id;
  robot.entity = index;
  robot.controller = *entity.controller;
  robot.params = entity.overrides_params ? entity.params : controller.params;
  robot.joint_sensors.begin = layout.joint_sensors.size();
  for (const scene::JointSensor& sensor : controller.devices.joint_sensors) {
    layout.joint_sensors.push_back({sensor.joint, sensor.mode == scene::JointMode::velocity,
                                    sensor.mode == scene::JointMode::disabled});
  }
  robot.joint_sensors.count = controller.devices.joint_sensors.size();
  robot.joint_actuators.begin = layout.joint_actuators.size();
  for (const scene::JointActuator& actuator : controller.devices.joint_actuators) {
    layout.joint_actuators.push_back({actuator.joint, actuator.mode == scene::JointMode::velocity,
                                      actuator.mode == scene::JointMode::disabled,
                                      actuator.max_impulse});
  }
  robot.joint_actuators.count = controller.devices.joint_actuators.size();
  layout.robots.push_back(std::move(robot));
}

}  // namespace

world::Layout make_layout(const scene::Scene& scene, const std::vector<scene::Entity>& entities) {
  world::Layout layout;
  for (std::size_t i = 0; i < entities.size(); ++i) {
    const scene::Entity& entity = entities[i];
    const bool single =
        entity.kind == scene::EntityKind::box || entity.kind == scene::EntityKind::cylinder;
    layout.entities.push_back({entity.id, {layout.links.size(), entity.links.size()}, !single});
    for (const scene::Link& link : entity.links) layout.links.push_back({single ? "" : link.id, i});
    if (entity.controller) add_robot(scene, entity, i, layout);
  }
  return layout;
}

}  // namespace ziggurat::simulation
