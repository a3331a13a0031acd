// SPDX-License-Identifier: MIT
// <joints> of a controller: motors and encoders, each listed with its mode.

#include <algorithm>
#include <array>

#include "scene/enabling.h"

namespace ziggurat::scene {
namespace {

OneOf<JointMode> joint_modes() {
  return {{"position", JointMode::position},
          {"velocity", JointMode::velocity},
          {"disabled", JointMode::disabled}};
}

/// @param key  what of a joint may be listed once, from its id and mode
template <class Key, class Read>
void read_joint_list(Element& element, Key key, Read read) {
  constexpr std::string_view known[] = {"joint"};
  Ids ids;
  for (Element& joint : element.children()) {
    if (joint.name() != "joint") {
      joint.unknown_in("joints", known);
      continue;
    }
    const std::string id = joint.required("id", identifier);
    const JointMode mode = joint.required("mode", joint_modes(), JointMode::disabled);
    if (!id.empty() && !ids.add(key(id, mode), joint.where())) {
      joint.fault_at("id",
                     fmt::format("is listed twice, first{}; list it once",
                                 joint.report().place(ids.owner(key(id, mode)), joint.where())));
    }
    read(joint, id, mode);
    joint.done();
  }
}

/// The strength of a motor: an impulse per substep, or a force.
void read_strength(Element& joint, JointActuator& actuator) {
  const auto force = joint.optional("max_force", In{"N", non_negative});
  const auto torque = joint.optional("max_torque", In{"N·m", non_negative});
  actuator.is_torque = torque.has_value();
  actuator.max_force = torque ? torque : force;
  actuator.max_impulse = joint.optional("max_impulse", In{"N·s or N·m·s", non_negative}, 0.0);
  constexpr std::array<std::string_view, 3> strengths{"max_force", "max_torque", "max_impulse"};
  const auto given = std::ranges::count_if(
      strengths, [&](std::string_view name) { return joint.has(name.data()); });
  if (given == 0) missing_all(joint, strengths);
  if (given > 1)
    joint.fault("has more than one of max_force, max_torque and max_impulse; write one");
}

}  // namespace

void enable_joint_actuators(const Enabling& e) {
  const auto once = [](const std::string& id, JointMode) { return id; };
  read_joint_list(e.element, once, [&](Element& joint, const std::string& id, JointMode mode) {
    JointActuator actuator{id, mode, 0, joint.where()};
    read_strength(joint, actuator);
    if (!id.empty()) e.devices.joints.actuators.push_back(actuator);
  });
}

/// A joint may have a sensor of its position and one of its velocity.
void enable_joint_sensors(const Enabling& e) {
  const auto once_in_each_mode = [](const std::string& id, JointMode mode) {
    return mode == JointMode::velocity ? id + "\n" : id;  // no id has a line break
  };
  read_joint_list(e.element, once_in_each_mode,
                  [&](Element& joint, const std::string& id, JointMode mode) {
                    if (!id.empty()) e.devices.joints.sensors.push_back({id, mode, joint.where()});
                  });
}

}  // namespace ziggurat::scene
