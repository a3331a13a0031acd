// SPDX-License-Identifier: MIT
#include "physics/build.h"

#include <algorithm>
#include <cmath>

#include "physics/bodies/bodies.h"
#include "physics/collision/shape.h"
#include "physics/flight.h"
#include "physics/magnet_source.h"
#include "physics/welding.h"

namespace ziggurat::physics {
namespace {

using math::Pose;

LinkBody link_body(const scene::Link& link, bool moves, const Pose& placed) {
  LinkBody body;
  body.moves = moves;
  body.mass = link.mass;
  body.inertia = inertia(link.geometry, link.mass);
  body.center = shape_frame(link.geometry);
  body.half_extents = half_extents(link.geometry);
  body.damping = link.damping;
  body.placed = placed;
  return body;
}

/// Ground motion of a body on wheels or on a plane, unless it is loose.
std::optional<scene::Traction> traction_of(const scene::Entity& entity,
                                           const scene::Physics& physics) {
  if (!entity.movable || entity.traction || entity.flight) return entity.traction;
  if (entity.kind == scene::EntityKind::prototype) return std::nullopt;
  const scene::Plane* plane = physics.flat ? plane_of(entity, physics) : nullptr;
  if (!plane) return std::nullopt;
  return entity.kind == scene::EntityKind::box ? plane->box : plane->cylinder;
}

/// Frames without body move with the first link.
void add_frames(Body& body, const scene::Entity& entity, const std::vector<Pose>& placed) {
  const Pose into = math::inverse(placed[0] * body.links[0].center);
  for (std::size_t i = 1; i < entity.links.size(); ++i) {
    LinkBody frame = link_body(entity.links[i], true, placed[i]);
    frame.in_part = into * placed[i];
    body.links.push_back(frame);
  }
  if (entity.turret) body.turret = Turret{.link = *entity.turret};
}

void make_single_part(Body& body, const scene::Entity& entity, const std::vector<Pose>& placed) {
  const LinkBody shape = link_body(entity.links[0], entity.movable, placed[0]);
  body.parts.push_back({shape.moves, shape.mass, shape.inertia});
  body.links.push_back(shape);
  add_frames(body, entity, placed);
}

void make_parts(Body& body, const scene::Entity& entity, const std::vector<Pose>& assembled,
                const std::vector<Pose>& placed, bool magnetism) {
  for (std::size_t i = 0; i < entity.links.size(); ++i) {
    const bool moves = entity.movable || i != entity.reference_link;
    body.links.push_back(link_body(entity.links[i], moves, placed[i]));
  }
  if (magnetism) carry_turning_magnets(body.links, entity, assembled);
  body.parts = weld(body.links, entity, assembled);
}

}  // namespace

bool is_single_part(const scene::Entity& entity) {
  if (scene::is_single(entity.kind) || entity.flight) return true;
  if (entity.traction) return entity.joints.empty();
  return entity.kind == scene::EntityKind::prototype && entity.links.size() == 1 &&
         entity.links[0].collides && entity.devices.magnets.empty();
}

const scene::Plane* plane_of(const scene::Entity& entity, const scene::Physics& physics) {
  constexpr double tolerance = 1e-6;  // [m]
  for (const scene::Plane& plane : physics.planes) {
    if (std::abs(entity.pose.position.z() - plane.elevation) < tolerance) return &plane;
  }
  return nullptr;
}

Body make_body(const scene::Entity& entity, const scene::Physics& physics, std::size_t number) {
  Body body;
  body.entity = number;
  body.reference_link = entity.reference_link;
  body.placed = entity.pose;
  body.is_grippable = entity.is_grippable && entity.movable;
  for (const scene::Magnet& magnet : entity.devices.magnets)
    body.magnets.push_back({.scene = magnet});
  body.origin_from_reference = math::inverse(entity.links[entity.reference_link].offset);
  const std::vector<Pose> assembled = assemble(entity);
  body.links.reserve(entity.links.size());
  std::vector<Pose> placed;
  for (const Pose& pose : assembled) placed.push_back(entity.pose * pose);
  if (is_single_part(entity)) {
    make_single_part(body, entity, placed);
  } else {
    make_parts(body, entity, assembled, placed, physics.magnetism.has_value());
  }
  if (const auto traction = traction_of(entity, physics)) {
    body.ground = GroundMotion{.limits = *traction};
  }
  if (entity.flight)
    body.flight = FlyingBody{.limits = *entity.flight, .target = hover_at(entity.pose)};
  if (physics.magnetism) set_magnet_cores(body, entity);
  body.carries_magnets = std::ranges::any_of(
      body.links, [](const LinkBody& link) { return link.carrier != LinkBody::carries_itself; });
  return body;
}

}  // namespace ziggurat::physics
