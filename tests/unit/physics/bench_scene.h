// SPDX-License-Identifier: MIT
#pragma once
// Small worlds for physics tests, built without a scene file.

#include <string>
#include <vector>

#include "physics/collision/contact_limits.h"
#include "physics/world.h"
#include "scene/scene.h"

namespace ziggurat::physics::testing {

inline math::Quaternion about(const math::Vector3& axis, double angle) {
  return math::Quaternion(Eigen::AngleAxisd(angle, axis.normalized()));
}

inline const scene::Box cube{{0.1, 0.1, 0.1}};

inline math::Pose at(double x, double y, double z) {
  return {{x, y, z}, math::Quaternion::Identity()};
}

inline scene::Physics empty_space() { return {}; }

inline scene::Physics with_gravity(double g) {
  scene::Physics physics = empty_space();
  physics.gravity = g;
  return physics;
}

/// Distance of a fall from rest [m].
/// @param g  [m/s^2]  @param h  length of a substep [s]
inline double fall(double g, double h, int substeps) { return g * h * h * substeps * substeps / 2; }

inline scene::Physics with_floor(double g) {
  scene::Physics physics = with_gravity(g);
  physics.floor = scene::Floor{};
  return physics;
}

/// A link of a prototype, without damping.
inline scene::Link link(const std::string& id, const scene::Geometry& geometry, double mass,
                        const math::Pose& offset = {}) {
  scene::Link link;
  link.id = id;
  link.geometry = geometry;
  link.mass = mass;
  link.offset = offset;
  return link;
}

inline scene::Entity prototype(const std::string& id, const math::Pose& pose, bool movable,
                               std::vector<scene::Link> links) {
  scene::Entity entity;
  entity.id = id;
  entity.kind = scene::EntityKind::prototype;
  entity.movable = movable;
  entity.pose = pose;
  entity.links = std::move(links);
  return entity;
}

inline scene::Entity single(scene::EntityKind kind, const math::Pose& pose, bool movable,
                            const scene::Geometry& geometry, double mass) {
  scene::Entity entity = prototype("single", pose, movable, {link("", geometry, mass)});
  entity.kind = kind;
  entity.links[0].surface.rolling_friction = 2e-4;  // the scene reader's default
  return entity;
}

inline scene::Joint joint(scene::JointType type, const math::Vector3& axis,
                          const math::Pose& parent_frame, const math::Pose& child_frame) {
  scene::Joint joint;
  joint.id = "joint";
  joint.type = type;
  joint.axis = axis;
  joint.parent = 0;
  joint.child = 1;
  joint.parent_frame = parent_frame;
  joint.child_frame = child_frame;
  return joint;
}

/// @param offset  [m]  @param field  the dialect's unit; both in the link's frame
inline scene::Magnet magnet(int link, const math::Vector3& offset, const math::Vector3& field) {
  scene::Magnet magnet;
  magnet.anchor.link = link;
  magnet.offset = offset;
  magnet.passive_field = field;
  return magnet;
}

/// Error of a world with so many boxes in one place; empty: none.
inline std::string fault_of_crowd(const scene::Physics& physics, int count) {
  World world(physics, 0.01);
  try {
    for (int i = 0; i < count; ++i) {
      world.add(single(scene::EntityKind::box, at(0, 0, 5), true, cube, 1));
    }
    world.step();
  } catch (const TooManyContacts& fault) {
    return fault.what();
  }
  return "";
}

inline world::State state_of(const World& world) {
  world::State state;
  world.read(state);
  return state;
}

}  // namespace ziggurat::physics::testing
