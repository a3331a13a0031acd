// SPDX-License-Identifier: MIT
// Heaps solved by passes alone, as large ones are.

#include <gtest/gtest.h>

#include <cmath>

#include "../stepping/pile.h"

namespace ziggurat::dynamics {
namespace {

/// Passes until the residual is small, for all islands.
void gauss_seidel_only(System& system) {
  SolverOptions& options = system.solver().options;
  options.newton_work = options.most_impact_work = options.most_factorisation_work = 0;
  options.moving_speed = HUGE_VAL;
}

TEST(GaussSeidel, ConvergeForATowerThatStands) {
  testing::Touching world;
  world.planes.push_back({Vector3::Zero(), Vector3::UnitZ()});
  const int count = 5;
  const double side = 0.05, mass = 0.1, substep = 0.01;
  for (int i = 0; i < count; ++i) {
    world.add_box(Vector3::Constant(side), mass, testing::at(0, 0, side * (i + 0.5)), 0.7);
  }
  gauss_seidel_only(world.system);
  world.system.sleeping.enabled = false;
  Report last;
  for (int i = 0; i < 100; ++i) last = world.step(substep);
  EXPECT_LT(world.worst.residual, 5e-3);  // in the first substep, from no impulses
  EXPECT_LT(last.residual, 5e-5);
  Vector3 carried(0, 0, 0);
  for (const ContactPoint& contact : world.contacts) {
    if (contact.a.tree < 0 || contact.b.tree < 0) carried += contact.impulse;
  }
  const double weight = count * mass * testing::g * substep;
  EXPECT_NEAR(carried.z(), weight, 1e-3 * weight);
  EXPECT_LT((world.tree(count - 1).position[0] - Vector3(0, 0, side * (count - 0.5))).norm(), 1e-3);
}

TEST(GaussSeidel, KeepAPileNearTheContactLaw) {
  testing::Touching world = testing::pile(20);
  gauss_seidel_only(world.system);
  double late = 0;
  for (int i = 0; i < 100; ++i) {
    const Report report = world.step(0.01);
    EXPECT_EQ(report.most_interior_point_steps + report.most_iterations +
                  report.most_augmented_lagrangian_steps,
              0);
    EXPECT_LE(report.most_passes, world.system.solver().options.most_passes);
    if (i >= 70) late = std::max(late, report.residual);
  }
  EXPECT_LT(world.worst.residual, 2e-2);
  EXPECT_LT(late, 1e-3);
  for (const Tree& tree : world.system.trees) {
    EXPECT_LT(tree.velocity(0).norm(), 1e-2);
    EXPECT_GT(tree.position[0].z(), 0.004);
  }
}

// Its cubes tremble without end, by less than its solutions miss the law.
TEST(GaussSeidel, LetAHeapSleepThatOnlyTrembles) {
  testing::Touching world = testing::pile(50);
  gauss_seidel_only(world.system);
  int substeps = 0;
  while (substeps < 500 && !world.system.is_asleep(0)) ++substeps, world.step(0.01);
  EXPECT_LT(substeps, 500);
  EXPECT_GT(substeps, 70);  // it falls for 0.2 s, and must be quiet for 0.5
  for (int i = 0; i < 50; ++i) EXPECT_TRUE(world.system.is_asleep(i)) << i;
}

// 5 mm/s^2: slower than the bounds of heaps for 0.2 s.
TEST(GaussSeidel, DoNotLetWhatBeginsToSlideSleep) {
  testing::Touching world;
  const double friction = 0.7, acceleration = 5e-3, substep = 0.01;
  world.planes.push_back({Vector3::Zero(), Vector3::UnitZ()});
  world.add_box(Vector3::Constant(0.05), 0.1, testing::at(0, 0, 0.025), friction);
  world.gravity = Vector3(friction * testing::g + acceleration, 0, -testing::g);
  gauss_seidel_only(world.system);
  for (int i = 0; i < 200; ++i) world.step(substep);
  EXPECT_FALSE(world.system.is_asleep(0));
  EXPECT_NEAR(world.tree(0).v[3], 200 * substep * acceleration, 5e-4);
}

}  // namespace
}  // namespace ziggurat::dynamics
