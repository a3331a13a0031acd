// SPDX-License-Identifier: MIT
#pragma once
// Whole runs of scene files, for checks against physical laws.

#include <cmath>
#include <filesystem>
#include <string>

#include "checkout/checkout.h"
#include "scene/reader.h"
#include "simulation/simulation.h"

namespace ziggurat::simulation::testing {

inline scene::Scene read_scene(const std::filesystem::path& path,
                               scene::Clock clock = scene::Clock::nominal) {
  scene::ReadOptions options;
  options.clock = clock;
  scene::ReadResult result = scene::read_file(path, options);
  std::string problems;
  for (const scene::Problem& problem : result.problems) problems += to_string(problem) + "\n";
  if (!result.ok()) throw std::runtime_error(problems);
  return std::move(result.scene);
}

inline scene::Scene drop_scene(scene::Clock clock = scene::Clock::nominal) {
  return read_scene(checkout() / "scenes/dynamics3d_single_body_test.argos", clock);
}

inline scene::Scene vehicle_scene(scene::Clock clock = scene::Clock::nominal) {
  return read_scene(checkout() / "scenes/dynamics3d_multi_body_test.argos", clock);
}

/// Entities of the drop scene that fall: 1 cm boxes and cylinders, of 0.25 kg each.
constexpr double half = 0.005;   // [m]
constexpr double mass = 0.25;    // [kg]
constexpr double gravity = 9.8;  // [m/s^2]

inline bool falls(const world::EntityLayout& entity) { return entity.id.substr(1, 1) == "0"; }
inline bool is_box(const world::EntityLayout& entity) { return entity.id[0] == 'b'; }

/// Height of the lowest point of a falling body [m].
inline double lowest(const world::EntityLayout& entity, const math::Pose& pose) {
  const math::Vector3 up = pose.orientation.conjugate() * math::Vector3::UnitZ();
  const double centre = (pose * math::Vector3(0, 0, half)).z();
  const double round = std::hypot(up.x(), up.y());
  const double flat = std::fabs(up.x()) + std::fabs(up.y());
  return centre - half * (std::fabs(up.z()) + (is_box(entity) ? flat : round));
}

/// Kinetic and gravitational energy of a falling body [J].
inline double energy(const world::EntityLayout& entity, const world::LinkState& link) {
  const math::Vector3 arm = link.pose.orientation * math::Vector3(0, 0, half);
  const math::Vector3 velocity = link.velocity + link.angular_velocity.cross(arm);
  const math::Vector3 spin = link.pose.orientation.conjugate() * link.angular_velocity;
  const double cube = mass * 4 * half * half / 6;
  const double across = mass * (3 * half * half + 4 * half * half) / 12;
  const math::Vector3 inertia = is_box(entity)
                                    ? math::Vector3(cube, cube, cube)
                                    : math::Vector3(across, across, mass * half * half / 2);
  return mass * (velocity.squaredNorm() / 2 + gravity * (link.pose.position + arm).z()) +
         spin.dot(inertia.cwiseProduct(spin)) / 2;
}

/// Heading about z [rad], (-pi, pi].
inline double yaw(const math::Pose& pose) {
  const math::Vector3 ahead = pose.orientation * math::Vector3::UnitX();
  return std::atan2(ahead.y(), ahead.x());
}

}  // namespace ziggurat::simulation::testing
