// SPDX-License-Identifier: MIT
#include "simulation/layout.h"

namespace ziggurat::simulation {

void append(const scene::Scene& scene, const scene::Entity& entity, const devices::Devices& devices,
            double substep, world::Layout& layout) {
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
  devices.lay_out({entity, index, controller ? controller->devices : nothing, substep}, robot,
                  layout);
  if (!controller) return;
  robot.id = entity.id;
  robot.entity = index;
  robot.controller = *entity.controller;
  robot.draws_markers = controller->devices.draws_markers;
  robot.params = entity.overrides_params ? entity.params : controller->params;
  layout.robots.push_back(std::move(robot));
}

world::Layout make_layout(const scene::Scene& scene, const std::vector<scene::Entity>& entities,
                          double substep) {
  world::Layout layout;
  const devices::Devices devices;
  for (const scene::Entity& entity : entities) append(scene, entity, devices, substep, layout);
  return layout;
}

}  // namespace ziggurat::simulation
