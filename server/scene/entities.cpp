// The elements of an arena: <box>, <cylinder>, <prototype>; robots are read in robots/.

#include <array>

#include "scene/reading.h"

namespace ziggurat::scene {
namespace {

/// Lets a rolling cylinder of a few centimetres come to rest within seconds.
constexpr Surface single_body_surface{0.5, 2e-4};
constexpr Damping single_body_damping{0.0, 0.0};

constexpr std::array<std::pair<std::string_view, EntityKind>, 5> kinds{{
    {"box", EntityKind::box},
    {"cylinder", EntityKind::cylinder},
    {"prototype", EntityKind::prototype},
    {"foot-bot", EntityKind::foot_bot},
    {"e-puck", EntityKind::e_puck},
}};

Link read_single_link(Reading& reading, Element& element, Entity& entity) {
  Link link;
  link.where = element.where();
  if (entity.kind == EntityKind::box) {
    link.geometry = Box{element.required("size", size, math::Vector3::Ones())};
  } else {
    const double radius = element.required("radius", length, 1.0);
    link.geometry = Cylinder{radius, element.required("height", length, 1.0)};
  }
  entity.movable = element.required("movable", boolean, true);
  if (entity.movable) {
    link.mass = element.required("mass", mass, 1.0);
    if (!(link.mass > 0)) element.fault_at("mass", "is not positive; write more than 0 kg");
  } else {
    element.without_effect("mass", number, "the body does not move");
  }
  link.surface = read_surface(reading, element, single_body_surface);
  link.damping = read_damping(reading, element, single_body_damping);
  return link;
}

void read_single_body(Reading& reading, Element& element, Entity& entity, Placement placement) {
  entity.links.push_back(read_single_link(reading, element, entity));
  entity.pose = read_body(element, placement);
  if (auto leds = element.child("leds")) read_leds(reading, *leds, entity);
}

void read_prototype(Reading& reading, Element& element, Entity& entity, Placement placement) {
  entity.movable = element.optional("movable", boolean, true);
  entity.pose = read_body(element, placement);
  const bool rooted = read_links(reading, element, entity);
  read_joints(reading, element, entity, rooted);
  read_devices(reading, element, entity);
  read_controller_of(reading, element, entity);
}

}  // namespace

bool is_entity(std::string_view name) {
  for (const auto& [known, kind] : kinds) {
    if (known == name) return true;
  }
  return false;
}

math::Pose read_pose(Element& element) {
  return {element.optional("position", position, math::Vector3::Zero()),
          element.optional("orientation", orientation, math::Quaternion::Identity())};
}

math::Pose read_body(Element& element, Placement placement) {
  auto body =
      placement == Placement::distributed ? element.child("body") : element.required_child("body");
  if (!body) return {};
  if (placement == Placement::distributed && (body->has("position") || body->has("orientation"))) {
    body->document().notice(body->where(),
                            "position and orientation of a distributed entity's <body> have no "
                            "effect: <distribute> draws them");
  }
  const math::Pose pose = read_pose(*body);
  body->done();
  return placement == Placement::distributed ? math::Pose{} : pose;
}

Entity read_entity(Reading& reading, Element& element, Placement placement) {
  Entity entity;
  entity.where = element.where();
  for (const auto& [name, kind] : kinds) {
    if (name == element.name()) entity.kind = kind;
  }
  entity.id = element.required("id", identifier);
  reading.anchors.clear();
  reading.document.subject = fmt::format("{} {}", element.name(), in_quotes(entity.id));
  switch (entity.kind) {
    case EntityKind::box:
    case EntityKind::cylinder:
      read_single_body(reading, element, entity, placement);
      break;
    case EntityKind::prototype:
      read_prototype(reading, element, entity, placement);
      break;
    case EntityKind::foot_bot:
    case EntityKind::e_puck:
      read_robot(reading, element, entity, placement);
      break;
  }
  element.done();
  reading.document.subject.clear();
  return entity;
}

std::string read_light(Reading& reading, Element& element, Placement placement) {
  reading.document.no_effect_yet(element.where(), "lights");
  const std::string id = element.required("id", identifier);
  reading.document.subject = fmt::format("light {}", in_quotes(id));
  if (placement == Placement::explicit_pose) {
    element.required("position", position);
  } else {
    element.optional("position", position);
  }
  element.optional("orientation", orientation);
  element.required("color", color);
  element.required("intensity", non_negative);
  read_medium(reading, element, MediumKind::led);
  element.done();
  reading.document.subject.clear();
  return id;
}

}  // namespace ziggurat::scene
