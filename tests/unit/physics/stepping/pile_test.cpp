// SPDX-License-Identifier: MIT
// Heaps that fall, strike and come to rest.

#include "pile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../../long_runs.h"

namespace ziggurat::dynamics {
namespace {

double energy(const testing::Touching& world) {
  double total = 0;
  for (const Tree& tree : world.system.trees) total += testing::energy(tree);
  return total;
}

/// Exact methods throughout, in place of passes while it moves.
testing::Touching exact_pile(int count) {
  testing::Touching world = testing::pile(count);
  world.system.solver().options.moving_speed = HUGE_VAL;
  world.system.solver().options.moving_change = 0;
  return world;
}

TEST(Pile, CubesInABinComeToRestWithinTheContactLaw) {
  testing::Touching world = exact_pile(long_runs::is_slow ? 5 : 20);
  double before = energy(world);
  for (int i = 0; i < 150; ++i) {
    const Report report = world.step(0.01);
    EXPECT_LT(report.residual, 1e-4) << i;
    // Undoing overlaps lifts bodies a little.
    const double now = energy(world);
    EXPECT_LT(now, before + 1e-5) << i;
    before = now;
  }
  for (const Tree& tree : world.system.trees) EXPECT_LT(tree.velocity(0).norm(), 1e-6);
}

TEST(Pile, FewCubesThatStrikeMissTheContactLawByLessThanAMillimetrePerSecond) {
  testing::Touching world = exact_pile(15);
  for (int i = 0; i < 60; ++i) EXPECT_LT(world.step(0.01).residual, 1e-3) << i;
}

/// Deepest overlap of a heap in its first second [m].
double deepest_overlap(testing::Touching world) {
  double deepest = 0;
  for (int i = 0; i < 100; ++i) {
    world.step(0.01);
    for (const ContactPoint& contact : world.contacts) deepest = std::max(deepest, -contact.gap);
  }
  return deepest;
}

TEST(Pile, CubesThatStrikeOverlapNoDeeperByPassesThanByExactMethods) {
  EXPECT_LT(deepest_overlap(testing::pile(30)), 1.1 * deepest_overlap(exact_pile(30)));
}

// Passes solve a moving heap approximately. Its energy falls all the same, and it comes to rest.
TEST(Pile, ManyCubesThatStrikeGainNoEnergyAndComeToRest) {
  testing::Touching world = testing::pile(long_runs::is_slow ? 30 : 50);
  const double first = energy(world);
  double before = first;
  for (int i = 0; i < 150; ++i) {
    world.step(0.01);
    const double now = energy(world);
    EXPECT_LT(now, before + 1e-5 * first) << i;
    before = now;
  }
  for (const ContactPoint& contact : world.contacts) EXPECT_GT(contact.gap, -1e-5);
  for (const Tree& tree : world.system.trees) EXPECT_LT(tree.velocity(0).norm(), 1e-6);
}

// Nothing presses them together.
TEST(Pile, TwoThatFloatComeApart) {
  testing::Touching world;
  world.gravity.setZero();
  const double side = 0.1;
  for (const double x : {0.0, 0.09})
    world.add_box(Vector3::Constant(side), x > 0 ? 1 : 3, {{x, 0, 0}, Quaternion::Identity()}, 0.5);
  for (Tree& tree : world.system.trees) tree.v[5] = 0.1;
  for (int i = 0; i < 10; ++i) world.step(0.01);
  const Vector3 a = world.tree(0).pose(0).position, b = world.tree(1).pose(0).position;
  EXPECT_NEAR(b.x() - a.x(), side, 2e-6);
  EXPECT_NEAR(3 * a.x() + b.x(), 0.09, 1e-9);  // neither is moved alone
  EXPECT_NEAR(a.z(), 0.01, 1e-9);
  for (Tree& tree : world.system.trees) EXPECT_NEAR(tree.velocity(0).x(), 0, 1e-9);
}

TEST(Pile, TwoThatFloatAndTurnGainNothingAsTheyComeApart) {
  for (const double hz : long_runs::some_of({50, 200, 1000})) {
    testing::Touching world;
    world.gravity.setZero();
    world.add_box({0.3, 0.1, 0.05}, 1, {Vector3::Zero(), Quaternion::Identity()}, 0);
    world.add_box({0.1, 0.2, 0.05}, 0.3, {{0.14, 0.02, 0.04}, Quaternion::Identity()}, 0);
    for (Tree& tree : world.system.trees) tree.v[1] = 2, tree.v[2] = 1, velocity_kinematics(tree);
    const double before = energy(world);
    for (int i = 0; i < hz / 5; ++i) world.step(1 / hz);
    EXPECT_LT(energy(world), before * (1 + 1e-8)) << hz;
    for (const ContactPoint& contact : world.contacts) EXPECT_GT(contact.gap, -1e-5) << hz;
  }
}

// Also where Newton's method does not find the displacement: light boxes between heavy ones take
// very many passes.
TEST(Pile, FourFifthsOfEachOverlapGoInASubstep) {
  constexpr int count = 10;
  constexpr double side = 0.1, overlap = 5e-3;
  testing::Touching world;
  world.system.solver().options.newton_work = 0;
  world.gravity.setZero();
  world.planes.push_back({Vector3::Zero(), Vector3::UnitZ()});
  for (int i = 0; i < count; ++i) {
    world.add_box(Vector3::Constant(side), i % 2 == 0 ? 0.1 : 5,
                  {{0, 0, side / 2 + i * (side - overlap)}, Quaternion::Identity()}, 0.5);
  }
  world.step(0.01);
  const auto height = [&](int i) { return world.tree(i).pose(0).position.z(); };
  EXPECT_GT(height(0), side / 2 - 2e-5);
  for (int i = 1; i < count; ++i)
    EXPECT_NEAR(height(i) - height(i - 1), side - overlap / 5, 2e-5) << i;
}

}  // namespace
}  // namespace ziggurat::dynamics
