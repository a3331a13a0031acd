// SPDX-License-Identifier: MIT
// The four-wheeled vehicle turns in place and drives straight.

#include <gtest/gtest.h>

#include "runs.h"

namespace ziggurat::simulation {
namespace {

using namespace testing;

/// Figures of one run of the vehicle.
struct Trip {
  double turned = 0;          ///< about z, summed over the ticks [rad]
  double away = 0;            ///< greatest horizontal distance from the start at any tick [m]
  double most_deviation = 0;  ///< of an encoder from its target, from tick 1 on [rad/s]
  math::Vector3 end;          ///< position of the origin after the last tick [m]
};

/// @param left,right  targets of the wheels on either side, each about its own outward axis [rad/s]
Trip run_vehicle(const scene::Scene& scene, double left, double right, int ticks) {
  Simulation run(scene, {.seed = 1});
  const auto& layout = run.layout();
  std::size_t vehicle = 0;
  while (layout.entities[vehicle].id != "vehicle") ++vehicle;
  const auto target = [&](const std::string& id) { return id.back() == 'l' ? left : right; };
  for (std::size_t i = 0; i < layout.joint_actuators.size(); ++i) {
    run.commands().joint_targets[i] = target(layout.joint_actuators[i].id);
  }
  Trip result;
  const math::Vector3 start = run.state().origins[vehicle].position;
  for (int tick = 1; tick <= ticks; ++tick) {
    const double before = yaw(run.state().origins[vehicle]);
    run.step();
    result.turned += std::remainder(yaw(run.state().origins[vehicle]) - before, 2 * M_PI);
    result.end = run.state().origins[vehicle].position;
    result.away = std::max(result.away, (result.end - start).head<2>().norm());
    for (std::size_t i = 0; i < layout.joint_sensors.size(); ++i) {
      const double deviation =
          run.observations().joint_readings[i] - target(layout.joint_sensors[i].id);
      result.most_deviation = std::max(result.most_deviation, std::fabs(deviation));
    }
  }
  EXPECT_EQ(layout.joint_sensors.size(), 4u);
  return result;
}

TEST(Vehicle, SpinsClockwiseInPlace) {
  const Trip result = run_vehicle(vehicle_scene(), 1, 1, 300);
  EXPECT_LT(result.most_deviation, 0.02);
  EXPECT_LT(result.turned, -5);
  EXPECT_LT(result.away, 0.01);
}

TEST(Vehicle, DrivesStraightInAnOpenArena) {
  scene::Scene scene = vehicle_scene();
  std::erase_if(scene.entities, [](const scene::Entity& entity) { return entity.id != "vehicle"; });
  scene.arena.size = {4, 4, 0.5};
  // 1 rad/s on wheels of 2 cm for a minute.
  const Trip forward = run_vehicle(scene, -1, 1, 300);
  EXPECT_NEAR(std::fabs(forward.end.x()), 1.2, 0.024);
  EXPECT_NEAR(forward.end.y(), 0, 0.01);
  EXPECT_NEAR(forward.turned, 0, 0.02);
  EXPECT_LT(forward.most_deviation, 0.02);
  const Trip backward = run_vehicle(scene, 1, -1, 300);
  EXPECT_NEAR(backward.end.x(), -forward.end.x(), 0.01);
}

TEST(Vehicle, TurnsUnderTheSlowClockAsTheReferenceDid) {
  const Trip result = run_vehicle(vehicle_scene(scene::Clock::beta50), 1, 1, 300);
  EXPECT_NEAR(result.turned, -1.03, 0.15 * 1.03);
  EXPECT_LT(result.most_deviation, 0.06);
  EXPECT_LT(result.away, 0.005);
}

}  // namespace
}  // namespace ziggurat::simulation
