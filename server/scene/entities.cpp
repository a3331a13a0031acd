// SPDX-License-Identifier: MIT
// The elements of an arena: <box>, <cylinder>, <sphere>, <prototype>, <light>; robots are read in
// robots/.

#include <algorithm>
#include <array>

#include "scene/draft.h"
#include "scene/memory.h"

namespace ziggurat::scene {
namespace {

/// Lets a rolling cylinder of a few centimetres come to rest within seconds.
constexpr Surface single_body_surface{0.5, 2e-4};
constexpr Damping single_body_damping{0.0, 0.0};

/// A prototype that comes as it is.
constexpr std::string_view block_element = "block";

constexpr std::array<std::pair<std::string_view, EntityKind>, 15> kinds{{
    {"box", EntityKind::box},
    {"cylinder", EntityKind::cylinder},
    {"sphere", EntityKind::sphere},
    {"prototype", EntityKind::prototype},
    {"light", EntityKind::light},
    {"foot-bot", EntityKind::foot_bot},
    {"e-puck", EntityKind::e_puck},
    {"eye-bot", EntityKind::eye_bot},
    {"spiri", EntityKind::spiri},
    {"mini-quadrotor", EntityKind::mini_quadrotor},
    {"kilobot", EntityKind::kilobot},
    {"pipuck", EntityKind::pi_puck},
    {"builderbot", EntityKind::builderbot},
    {"kheperaiv", EntityKind::khepera},
    {block_element, EntityKind::prototype},
}};

}  // namespace

void stay(Report& report, Location where, Entity& entity, Link& link) {
  report.notice(where, fmt::format("a mass of {:g} kg is one that nothing moves, and is read as "
                                   "movable=\"false\"; write that instead of it",
                                   link.mass));
  entity.movable = false;
  link.mass = 0;
}

namespace {

Link read_single_link(Draft& draft, Element& element, Entity& entity) {
  Link link;
  link.where = element.where();
  link.geometry = read_shape(draft, element, to_string(entity.kind));
  entity.movable = element.required("movable", boolean, true);
  if (entity.movable) {
    link.mass = element.required("mass", mass, 1.0);
    if (!(link.mass > 0)) element.fault_at("mass", "is not positive; write more than 0 kg");
    if (link.mass > heaviest_mass) stay(draft.report, element.where("mass"), entity, link);
  } else {
    element.without_effect("mass", number, "the body does not move");
  }
  link.surface = read_surface(draft, element, single_body_surface);
  link.damping = read_damping(draft, element, single_body_damping);
  return link;
}

void read_single_body(Draft& draft, Element& element, Entity& entity) {
  entity.links.push_back(read_single_link(draft, element, entity));
  if (auto leds = element.child("leds")) read_leds(draft, *leds, entity);
}

void read_prototype(Draft& draft, Element& element, Entity& entity) {
  entity.movable = element.optional("movable", boolean, true);
  const bool rooted = read_links(draft, element, entity);
  read_joints(draft, element, entity, rooted);
  read_devices(draft, element, entity);
}

/// A point that shines: a frame without body, with an LED that cameras see.
void read_light(Draft& draft, Element& element, Entity& entity) {
  entity.movable = false;
  Link& frame = entity.links.emplace_back();
  frame.where = element.where();
  frame.geometry = Sphere{0};
  frame.collides = false;
  entity.intensity = element.required("intensity", non_negative, 0.0);
  entity.devices.leds.push_back(
      {"light", {}, math::Vector3::Zero(), element.required("color", color), element.where()});
  entity.devices.led_medium = read_medium(draft, element, MediumKind::led);
}

/// The place of a light, which has no <body>.
math::Pose read_light_pose(Element& element, Placement placement) {
  if (placement != Placement::explicit_pose) {
    element.optional("position", position);
    element.optional("orientation", orientation);
    return {};
  }
  doubt_angles(element, "orientation");
  const math::Vector3 at = element.required("position", position);
  return {at, element.optional("orientation", orientation, math::Quaternion::Identity())};
}

/// Beginning of the ids of copies; empty: they are numbers alone.
Value<std::string> start_of_ids(std::string_view text) {
  return text.empty() ? Value<std::string>(std::string()) : identifier(text);
}

std::string read_entity_id(Element& element, Placement placement) {
  if (placement == Placement::looked_at) return element.optional("id", start_of_ids, "");
  return element.required("id", placement == Placement::distributed ? start_of_ids : identifier);
}

/// As the dialect's gripper holds them: what moves, but neither e-pucks nor prototypes.
bool is_usually_gripped(const Entity& entity) {
  return entity.movable && (is_single(entity.kind) || entity.kind == EntityKind::foot_bot);
}

}  // namespace

std::optional<EntityKind> entity_kind(std::string_view name) {
  for (const auto& [known, kind] : kinds) {
    if (known == name) return kind;
  }
  return std::nullopt;
}

std::vector<std::string_view> entity_names(std::initializer_list<std::string_view> others) {
  std::vector<std::string_view> names;
  for (const auto& [name, kind] : kinds) names.push_back(name);
  names.insert(names.end(), others);
  return names;
}

std::string_view to_string(EntityKind kind) {
  for (const auto& [name, known] : kinds) {
    if (known == kind) return name;
  }
  return {};
}

bool may_have_controller(EntityKind kind) {
  return kind == EntityKind::prototype || is_robot(kind);
}

void refuse_id(const Element& element, std::string_view what, Location earlier) {
  element.fault_at("id", fmt::format("is the id of an earlier {}{}; give each its own", what,
                                     element.report().place(earlier, element.where())));
  element.report().left_out(duplicate);
}

bool take_id(const Element& element, Ids& ids, const std::string& id, std::string_view what) {
  if (id.empty() || ids.add(id, element.where())) return true;
  refuse_id(element, what, ids.owner(id));
  return false;
}

void take_entity_id(Draft& draft, const Element& element, const std::string& id) {
  const auto director = std::ranges::find(draft.scene.directors, id, &Director::id);
  if (id.empty() || director == draft.scene.directors.end()) {
    take_id(element, draft.entity_ids, id, "entity");
    return;
  }
  element.fault_at("id", fmt::format("is also the id of the director{}; give each its own",
                                     draft.report.place(director->where, element.where())));
  draft.report.left_out(duplicate);
}

void doubt_angles(Element& element, const char* attribute) {
  if (!element.has(attribute)) return;
  const std::string written = element.optional(attribute, text, "");
  for (std::size_t begin = 0; begin <= written.size();) {
    const std::size_t end = std::min(written.find_first_of(",:", begin), written.size());
    const std::string angle(trimmed(std::string_view(written).substr(begin, end - begin)));
    begin = end + 1;
    const auto degrees = degrees_of_radians(angle);
    if (!degrees) continue;
    element.report().warn(
        element.where(attribute), "radians",
        element.sentence(attribute, fmt::format("looks like radians, and angles are "
                                                "in degrees; write {} for {}",
                                                *degrees, angle)));
    return;
  }
}

math::Pose read_pose(Element& element) {
  doubt_angles(element, "orientation");
  return {element.optional("position", position, math::Vector3::Zero()),
          element.optional("orientation", orientation, math::Quaternion::Identity())};
}

math::Pose read_body(Element& element, Placement placement) {
  auto body = placement == Placement::explicit_pose ? element.required_child("body")
                                                    : element.child("body");
  if (!body) return {};
  if (placement == Placement::distributed && (body->has("position") || body->has("orientation"))) {
    body->report().notice(body->where(),
                          "position and orientation of a distributed entity's <body> have no "
                          "effect: <distribute> draws them");
  }
  const math::Pose pose = read_pose(*body);
  body->done();
  return placement == Placement::explicit_pose ? pose : math::Pose{};
}

void read_body_and_devices(Draft& draft, Element& element, Entity& entity) {
  draft.anchors.clear();
  switch (entity.kind) {
    case EntityKind::box:
    case EntityKind::cylinder:
    case EntityKind::sphere:
      read_single_body(draft, element, entity);
      break;
    case EntityKind::prototype:
      element.name() == block_element ? read_block(draft, element, entity)
                                      : read_prototype(draft, element, entity);
      break;
    case EntityKind::light:
      read_light(draft, element, entity);
      break;
    default:
      read_robot(draft, element, entity);
  }
  entity.is_grippable = element.optional("grippable", boolean, is_usually_gripped(entity));
}

Entity read_entity(Draft& draft, Element& element, Placement placement) {
  Entity entity;
  entity.where = element.where();
  entity.kind = entity_kind(element.name()).value();
  entity.id = read_entity_id(element, placement);
  const auto model = element.optional("model", identifier);
  draft.report.subject = fmt::format("{} {}", element.name(), in_quotes(entity.id));
  if (model) draft.report.subject += fmt::format(" of model {}", in_quotes(*model));
  std::optional<ControllerChoice> controller;
  std::string elsewhere;
  if (element.has("model")) {
    elsewhere = apply_model(draft, element, model.value_or(""), entity, controller);
  } else {
    read_body_and_devices(draft, element, entity);
  }
  entity.pose = entity.kind == EntityKind::light ? read_light_pose(element, placement)
                                                 : read_body(element, placement);
  if (may_have_controller(entity.kind)) {
    if (auto own = read_controller_choice(draft, element)) controller = std::move(own);
    const bool lacks_controller = is_robot(entity.kind) && !controller;
    if (lacks_controller && placement != Placement::looked_at) element.required_child("controller");
    if (controller) give_controller(draft, *controller, entity);
  }
  const std::size_t of_model = entity.model ? draft.models[*entity.model].size : 0;
  take_memory(draft, element, memory_of(entity, controller_of(draft, entity)),
              element.size() + of_model);
  check_use(draft, entity);
  if (entity.model) {
    element.done(elsewhere, draft.models[*entity.model].names);
  } else {
    element.done(elsewhere);
  }
  draft.report.subject.clear();
  return entity;
}

}  // namespace ziggurat::scene
