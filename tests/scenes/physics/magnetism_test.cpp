// SPDX-License-Identifier: MIT
// Figure 2.2 of the report: four rows of five magnetic boxes.

#include <gtest/gtest.h>

#include "runs.h"

namespace ziggurat::simulation {
namespace {

using namespace testing;

scene::Scene rows_scene(scene::Clock clock = scene::Clock::nominal) {
  return read_scene(checkout() / "scenes/dynamics3d_magnetism_test.argos", clock);
}

constexpr std::size_t walls = 4, rows = 4, boxes = 5;

const math::Pose& box(const world::State& state, std::size_t row, std::size_t number) {
  return state.origins[walls + row * boxes + number];
}

/// Each box stands upright on the floor, in its row.
void expect_in_rows(const world::State& state) {
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t i = 0; i < boxes; ++i) {
      const math::Pose& pose = box(state, row, i);
      EXPECT_NEAR(pose.position.y(), 0.15 - 0.1 * static_cast<double>(row), 2e-3);
      EXPECT_NEAR(pose.position.z(), 0, 2e-3);
      EXPECT_LT(0.03 * std::acos(std::min(1.0, (pose.orientation * math::Vector3::UnitZ()).z())),
                2e-3);
    }
  }
}

TEST(MagneticRows, CloseAtTheNominalClock) {
  Simulation run(rows_scene(), {.seed = 1});
  for (int tick = 0; tick < 60; ++tick) run.step();  // 12 s
  EXPECT_EQ(run.convergence().not_converged, 0u);
  expect_in_rows(run.state());
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t i = 1; i < boxes; ++i) {
      const double gap =
          (box(run.state(), row, i - 1).position - box(run.state(), row, i).position).norm();
      EXPECT_NEAR(gap, 0.03, 2e-3) << "row " << row;
    }
  }
}

TEST(MagneticRows, FollowTheReferenceUnderItsClock) {
  // Poses of the first row in the recorded run of the reference simulator, mirrored in its middle.
  Simulation run(rows_scene(scene::Clock::beta50), {.seed = 1});
  const struct {
    std::uint64_t tick;
    double outer, inner;
  } recorded[] = {{5, 0.0972, 0.0500},
                  {10, 0.0845, 0.0515},
                  {15, 0.0743, 0.0443},
                  {25, 0.06, 0.03},
                  {40, 0.06, 0.03}};
  for (const auto& expected : recorded) {
    while (run.state().tick < expected.tick) run.step();
    const double x[] = {expected.outer, expected.inner, 0, -expected.inner, -expected.outer};
    for (std::size_t i = 0; i < boxes; ++i) {
      EXPECT_NEAR(box(run.state(), 0, i).position.x(), x[i], 2e-3) << "tick " << expected.tick;
    }
  }
  expect_in_rows(run.state());
}

TEST(MagneticRows, WarnWhereTheBondIsTooStiffForTheSubstep) {
  scene::Scene scene = rows_scene();
  EXPECT_TRUE(Simulation(scene, {}).notices().empty());
  scene.physics.iterations = 1;
  scene.physics.magnetism->force_constant *= 400;  // times 20 swings: substep times rate is 272
  const auto notices = Simulation(scene, {}).notices();
  ASSERT_EQ(notices.size(), 1u);
  EXPECT_NE(notices[0].find("'magnet0'"), std::string::npos) << notices[0];
  EXPECT_NE(notices[0].find("max_substep"), std::string::npos);
  scene.physics.max_substep = 0.02;  // 27
  EXPECT_TRUE(Simulation(scene, {}).notices().empty());
}

}  // namespace
}  // namespace ziggurat::simulation
