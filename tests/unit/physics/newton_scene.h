// SPDX-License-Identifier: MIT
#pragma once
// Worlds for tests of the core.

#include <cmath>

#include "bench_scene.h"

namespace ziggurat::physics::testing {

using math::Pose;
using math::Vector3;

constexpr double earth = 9.8;  // [m/s^2]

inline scene::Physics newton(bool floor = false, double gravity = earth) {
  scene::Physics physics = with_gravity(gravity);
  if (floor) physics.floor = scene::Floor{};
  return physics;
}

inline scene::Entity with_friction(scene::Entity entity, double friction) {
  for (scene::Link& link : entity.links) link.surface = {friction, 0};
  return entity;
}

inline scene::Entity standing(const Pose& pose, const scene::Geometry& geometry,
                              double friction = 0.5) {
  return with_friction(single(scene::EntityKind::box, pose, false, geometry, 0), friction);
}

inline scene::Entity loose(const Pose& pose, const scene::Geometry& geometry, double mass,
                           double friction = 0.5) {
  return with_friction(prototype("loose", pose, true, {link("body", geometry, mass)}), friction);
}

inline void run(World& world, double seconds, double h) {
  const int substeps = static_cast<int>(std::lround(seconds / h));
  for (int i = 0; i < substeps; ++i) world.step();
}

inline Pose origin(const World& world, std::size_t entity) {
  return state_of(world).origins[entity];
}

}  // namespace ziggurat::physics::testing
