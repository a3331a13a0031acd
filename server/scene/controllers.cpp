// SPDX-License-Identifier: MIT
// <controllers>: who drives the robots, with which devices, and whether each robot has them.

#include <algorithm>
#include <array>

#include "scene/draft.h"
#include "scene/memory.h"
#include "text/names.h"
#include "text/quoting.h"

namespace ziggurat::scene {
namespace {

constexpr unsigned most_faults_with_entities = 20;
constexpr std::size_t longest_type = 100;

void note_children_of_params(Element& params) {
  for (const Element& child : params.children()) {
    params.report().notice(child.where(),
                           "elements in <params> have no effect here: its attributes reach the "
                           "controller");
  }
}

void read_params(Element params, Controller& controller) {
  controller.params = params.all_attributes();
  controller.params_where = params.where();
  note_children_of_params(params);
  params.done();
}

/// Controllers of other types are libraries in C++, which a server does not load.
void note_type(Draft& draft, const Element& element, const Controller& controller) {
  if (!is_library(controller)) return;
  constexpr std::array<std::string_view, 2> own{"lua_controller", "external_controller"};
  constexpr std::size_t most_typos = 2;  // <epuck_controller> is none of ours
  for (const std::string_view ours : own) {
    if (text::edit_distance(element.name(), ours) > most_typos) continue;
    return draft.report.fault(
        element.where(), fmt::format("unknown element <{}> in <controllers>; did you mean <{}>?",
                                     element.name(), ours));
  }
  const std::string id = text::shell_word(controller.id.empty() ? "ID" : controller.id);
  draft.report.notice(
      element.where(),
      fmt::format("<{}> is a library in C++, which is not loaded into the server; {}: write its "
                  "rule in Lua as <lua_controller>, or as a program in C++ or Python and add "
                  "--controller {}=COMMAND",
                  element.name(),
                  draft.options.lenient ? "its robots stand still"
                                        : "the run waits for a client in its place, or with "
                                          "--lenient its robots stand still",
                  id));
}

void take_id(Draft& draft, const Element& element, const Controller& controller) {
  if (controller.id.empty()) return;
  const auto [earlier, fresh] =
      draft.controllers.emplace(controller.id, draft.scene.controllers.size());
  if (fresh) return;
  refuse_id(element, "controller", draft.scene.controllers[earlier->second].where);
}

enum class Origin { scene, included };

void read_controller(Draft& draft, Element& element, Origin origin,
                     const std::optional<DeadlinePolicy>& usual) {
  Controller controller;
  ControllerUse use;
  if (origin == Origin::included) draft.missing_parts = &use.missing_parts;
  controller.where = controller.params_where = element.where();  // until there is <params>
  controller.type = element.name();
  controller.lua = element.name() == "lua_controller";
  controller.id = element.required("id", identifier);
  draft.report.subject = fmt::format("controller {}", in_quotes(controller.id));
  if (is_library(controller)) {
    element.optional("library", text);
  } else {
    element.without_effect("library", text, "no libraries are loaded into the server");
  }
  if (controller.type == "external_controller") {
    controller.command = element.optional("command", text, "");
  }
  controller.deadline = read_deadline(element, usual);
  if (auto actuators = element.child("actuators")) {
    use.has_actuators = true;
    read_actuators(draft, *actuators, controller.devices, use);
  }
  if (auto sensors = element.child("sensors")) {
    use.has_sensors = true;
    read_sensors(draft, *sensors, controller.devices, use);
  }
  if (auto params = element.child("params")) {
    use.has_params = true;
    read_params(*params, controller);
  }
  controller.params = with_parameters(std::move(controller.params), draft.parameters);
  take_memory(draft, element, memory_of(controller.params), element.size());
  element.done();
  draft.missing_parts = nullptr;
  draft.report.subject.clear();
  note_type(draft, element, controller);
  take_id(draft, element, controller);
  draft.scene.controllers.push_back(std::move(controller));
  draft.uses.push_back(std::move(use));
}

// --- what an entity must have -------------------------------------------------------------------

struct Component {
  std::string_view device;
  bool (*is_carried)(const Entity&);
  std::string_view element;  ///< that would give the entity one
};

constexpr std::array<Component, 8> components{{
    {"radios", [](const Entity& e) { return !e.devices.radios.empty(); }, "radios"},
    {"leds", [](const Entity& e) { return !e.devices.leds.empty(); }, "leds"},
    {"directional_leds", [](const Entity& e) { return !e.devices.directional_leds.empty(); },
     "directional_leds"},
    {"tags", [](const Entity& e) { return !e.devices.tags.empty(); }, "tags"},
    {"magnets", [](const Entity& e) { return !e.devices.magnets.empty(); }, "magnets"},
    {"proximity", [](const Entity& e) { return !e.devices.proximity_sensors.empty(); },
     "proximity_sensors"},
    {"range_and_bearing", [](const Entity& e) { return e.devices.range_and_bearing.has_value(); },
     "range_and_bearing"},
    {"battery", [](const Entity& e) { return e.devices.battery.has_value(); }, "battery"},
}};

template <EntityKind kind>
bool is(const Entity& entity) {
  return entity.kind == kind;
}

bool has_wifi(const Entity& entity) {
  return is_robot(entity.kind) && std::ranges::find(entity.devices.radios, "wifi", &Radio::id) !=
                                      entity.devices.radios.end();
}

constexpr auto robot_components = std::to_array<Component>({
    {"differential_steering", [](const Entity& e) { return e.axle_length.has_value(); }, ""},
    {"footbot_turret", [](const Entity& e) { return e.turret.has_value(); }, ""},
    {"footbot_turret_encoder", [](const Entity& e) { return e.turret.has_value(); }, ""},
    {"wifi", has_wifi, ""},
    {"footbot_proximity", is<EntityKind::foot_bot>, ""},
    {"epuck_wheels", is<EntityKind::e_puck>, ""},
    {"epuck_leds", is<EntityKind::e_puck>, ""},
    {"epuck_range_and_bearing", is<EntityKind::e_puck>, ""},
    {"eyebot_proximity", is<EntityKind::eye_bot>, ""},
    {"kilobot_led", is<EntityKind::kilobot>, ""},
    {"pipuck_leds", is<EntityKind::pi_puck>, ""},
    {"builderbot_leds", is<EntityKind::builderbot>, ""},
    {"builderbot_electromagnet_system", is<EntityKind::builderbot>, ""},
    {"builderbot_camera_system", is<EntityKind::builderbot>, ""},
    {"kheperaiv_leds", is<EntityKind::khepera>, ""},
    {"kheperaiv_proximity", is<EntityKind::khepera>, ""},
    {"builderbot_nfc", is<EntityKind::builderbot>, ""},
});

/// Whether a built-in robot has a device that is not in the table `components`.
bool comes_with(const Entity& entity, std::string_view device) {
  const auto found = std::ranges::find(robot_components, device, &Component::device);
  return found != robot_components.end() && found->is_carried(entity);
}

std::string_view kind_of(const Entity& entity) { return to_string(entity.kind); }

/// Part that an entity needs for a device and does not have, or nothing.
std::optional<std::string> missing_for(const Entity& entity, const DeviceUse& use) {
  const bool prototype = entity.kind == EntityKind::prototype;
  const auto& places = entity.devices.places;
  if (!use.places.empty() &&
      std::ranges::find(places, use.places, &DevicePlace::name) != places.end()) {
    return {};
  }
  const auto component = std::ranges::find(components, use.name, &Component::device);
  if (component != components.end()) {
    if (component->is_carried(entity)) return {};
    if (prototype || use.name == "battery") {
      return fmt::format("has none; write <{}> into {}, or remove the device", component->element,
                         prototype ? "its <devices>" : "it");
    }
  } else if (use.places.empty() && !prototype && comes_with(entity, use.name)) {
    return {};
  }
  return fmt::format("is of kind {} and has none; remove the device, or use another controller",
                     kind_of(entity));
}

/// One device of a controller against one entity at a time.
struct Check {
  Draft& draft;
  const Entity& entity;
  ControllerUse& use;

  void blame(Location where, std::string text, std::vector<std::string_view> causes = {}) const {
    if (!draft.blamed.insert(where).second) return;
    ++use.faults;
    draft.report.fault(where, std::move(text), std::move(causes));
  }

  enum class Device { sensor, actuator };
  void check_joint(const std::string& id, Location where, Device device,
                   const std::unordered_map<std::string_view, const Joint*>& joints) const {
    const auto found = joints.find(id);
    if (found == joints.end()) {
      std::vector<std::string> known;
      for (std::size_t i = 0; i < std::min(entity.joints.size(), most_compared); ++i)
        known.push_back(entity.joints[i].id);
      blame(where,
            fmt::format("joint {} does not exist in {} {}; {}", in_quotes(id), kind_of(entity),
                        in_quotes(entity.id),
                        known.empty() ? "it has none; write <joints> into it"
                                      : draft.report.advice(id, known)),
            {"joints", "joint", "links", "link", "id", duplicate});
      return;
    }
    const JointType type = found->second->type;
    if (has_coordinate(type)) return;
    const std::string_view is = type == JointType::fixed ? "fixed" : "spherical";
    if (device == Device::actuator) {
      blame(where, fmt::format("joint {} of {} {} is {}; only prismatic and revolute joints "
                               "have an actuator",
                               in_quotes(id), kind_of(entity), in_quotes(entity.id), is));
    } else {
      draft.report.notice(where, fmt::format("the sensor of joint {} always reads 0: the joint "
                                             "is {}",
                                             in_quotes(id), is));
    }
  }

  /// A force is for a prismatic joint, a torque for a revolute one.
  void check_strength(const JointActuator& actuator, const Joint& joint) const {
    const bool revolute = joint.type == JointType::revolute;
    if (!actuator.max_force || !has_coordinate(joint.type) || actuator.is_torque == revolute)
      return;
    blame(actuator.where,
          fmt::format("joint {} of {} {} is {}; write {} instead of {}", in_quotes(joint.id),
                      kind_of(entity), in_quotes(entity.id), revolute ? "revolute" : "prismatic",
                      revolute ? "max_torque" : "max_force", revolute ? "max_force" : "max_torque"),
          {joint_type});
  }

  void check_joints(const ControllerDevices& devices) const {
    std::unordered_map<std::string_view, const Joint*> joints;
    for (const Joint& joint : entity.joints) joints.emplace(joint.id, &joint);
    for (const JointActuator& a : devices.joints.actuators) {
      check_joint(a.joint, a.where, Device::actuator, joints);
      if (const auto found = joints.find(a.joint); found != joints.end()) {
        check_strength(a, *found->second);
      }
    }
    for (const JointSensor& s : devices.joints.sensors)
      check_joint(s.joint, s.where, Device::sensor, joints);
  }

  void check_anchors() const {
    for (const AnchorUse& device : use.anchors) {
      const std::string& anchor = device.anchor;
      if (anchor.empty() || anchor == "origin" || draft.anchors.contains(anchor)) continue;
      blame(device.where,
            fmt::format("anchor {} of {} does not exist in {} {}; {}", in_quotes(anchor),
                        device.device, kind_of(entity), in_quotes(entity.id),
                        draft.report.advice(anchor, anchor_names(draft))),
            {"links", "link", "id", duplicate});
    }
  }

  void check_components() const {
    for (const DeviceUse& device : use.devices) {
      if (const auto what = missing_for(entity, device)) {
        const auto component = std::ranges::find(components, device.name, &Component::device);
        std::vector<std::string_view> causes{"devices"};
        if (component != components.end()) causes.push_back(component->element);
        std::string text =
            fmt::format("{} {} enabled for entity {}, which {}", device.name,
                        device.name.ends_with('s') ? "are" : "is", in_quotes(entity.id), *what);
        if (!draft.options.lenient) {
          blame(device.where, std::move(text), std::move(causes));
        } else if (draft.blamed.insert(device.where).second) {
          draft.report.notice(device.where, text + "; it goes without");
        }
      }
    }
  }
};

/// Faults of a controller that only matter once an entity uses it.
void check_sections(const Draft& draft, const Controller& controller, const Entity& entity,
                    ControllerUse& use) {
  const auto report = [&](const char* name) {
    draft.report.fault(controller.where,
                       fmt::format("controller {} lacks the element <{}>; write <{}/> in it",
                                   in_quotes(controller.id), name, name),
                       {name});
  };
  if (!use.has_actuators) report("actuators");
  if (!use.has_sensors) report("sensors");
  use.has_actuators = use.has_sensors = true;  // each is reported once
  if (!use.has_params && !entity.overrides_params && controller.lua) {
    report("params");
    use.has_params = true;
  }
}

}  // namespace

void check_use(Draft& draft, const Entity& entity) {
  if (!entity.controller) return;
  const Controller& controller = draft.scene.controllers[*entity.controller];
  ControllerUse& use = draft.uses[*entity.controller];
  report_missing(draft, use.missing_parts);
  check_sections(draft, controller, entity, use);
  if (use.faults > most_faults_with_entities) return;
  const Check check{draft, entity, use};
  check.check_joints(controller.devices);
  check.check_anchors();
  check.check_components();
}

namespace {

void read_list(Draft& draft, Element& controllers, Origin origin) {
  const auto deadline = read_deadline(controllers, std::nullopt);
  for (Element& element : controllers.children()) {
    if (element.name().size() > longest_type) {
      draft.report.fault(element.where(), fmt::format("{} is too long for a type of controller; "
                                                      "write lua_controller",
                                                      in_quotes(element.name())));
    } else if (const auto why = unsupported_element(element.name())) {
      draft.report.fault(element.where(),
                         fmt::format("<{}> is not supported; {}", element.name(), *why));
    } else {
      read_controller(draft, element, origin, deadline);
    }
  }
  controllers.done();
}

}  // namespace

void report_missing(Draft& draft, std::vector<PendingFault>& missing_parts) {
  for (PendingFault& fault : missing_parts) {
    draft.report.fault(fault.where, std::move(fault.text), std::move(fault.causes));
  }
  missing_parts.clear();
}

void read_controllers(Draft& draft, Element& root, std::span<Element> included) {
  if (auto controllers = root.required_child("controllers")) {
    read_list(draft, *controllers, Origin::scene);
  }
  for (Element& controllers : included) read_list(draft, controllers, Origin::included);
}

std::optional<ControllerChoice> read_controller_choice(Draft& draft, Element& element) {
  auto user = element.child("controller");
  if (!user) return std::nullopt;
  ControllerChoice choice;
  choice.id = user->required("config", identifier);
  if (auto params = user->child("params")) {
    choice.params = params->all_attributes();
    choice.params_where = params->where();
    note_children_of_params(*params);
    params->done();
  }
  user->done();
  if (choice.id.empty()) return std::nullopt;
  if (!draft.controllers.contains(choice.id)) {
    std::vector<std::string> known;
    const auto& all = draft.scene.controllers;
    for (std::size_t i = 0; i < std::min(all.size(), most_compared); ++i)
      known.push_back(all[i].id);
    choice.unknown = {
        user->where("config"),
        user->sentence("config", known.empty() ? "names no controller; write it in <controllers>"
                                               : "names no controller; " +
                                                     draft.report.advice(choice.id, known)),
        {"controllers", "lua_controller", "external_controller", "include", "id"}};
  }
  return choice;
}

void give_controller(Draft& draft, const ControllerChoice& choice, Entity& entity) {
  entity.overrides_params = choice.params.has_value();
  entity.params_where = choice.params_where;
  if (choice.params) entity.params = with_parameters(*choice.params, draft.parameters);
  const auto found = draft.controllers.find(choice.id);
  if (found == draft.controllers.end()) {
    if (draft.blamed.insert(choice.unknown.where).second) {
      draft.report.fault(choice.unknown.where, choice.unknown.text, choice.unknown.causes);
    }
    return;
  }
  entity.controller = found->second;
}

bool is_library(const Controller& controller) {
  return !controller.lua && controller.type != "external_controller";
}

const Controller* controller_of(const Draft& draft, const Entity& entity) {
  return entity.controller ? &draft.scene.controllers[*entity.controller] : nullptr;
}

}  // namespace ziggurat::scene
