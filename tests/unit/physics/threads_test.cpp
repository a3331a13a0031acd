// SPDX-License-Identifier: MIT
// A world has the same bits for any number of threads.

#include <gtest/gtest.h>

#include "bench_scene.h"

namespace ziggurat::physics {
namespace {

using namespace testing;

/// Forty heaps of three: boxes, balls and pairs of boxes on a joint.
void fill(World& world) {
  for (int i = 0; i < 120; ++i) {
    const math::Pose pose{{0.3 * (i % 8), 0.3 * (i / 8 % 5), 0.1 + 0.15 * (i / 40)},
                          about({1, 0.3 * i, 2}, 0.01 * i)};
    if (i % 4 == 0) {
      world.add(single(scene::EntityKind::cylinder, pose, true, scene::Sphere{0.04}, 0.2));
    } else if (i % 4 == 1) {
      scene::Entity pair = prototype("pair", pose, true,
                                     {link("a", scene::Box{{0.06, 0.05, 0.04}}, 0.3),
                                      link("b", scene::Capsule{0.02, 0.03}, 0.1, at(0, 0, 0.05))});
      pair.joints.push_back(joint(scene::JointType::revolute, math::Vector3::UnitX(),
                                  at(0, 0, 0.045), at(0, 0, -0.005)));
      world.add(pair);
    } else {
      world.add(single(scene::EntityKind::box, pose, true, scene::Box{{0.08, 0.07, 0.05}}, 0.4));
    }
  }
}

std::vector<double> state_after(unsigned threads, int substeps) {
  World world(with_floor(9.8), 0.01);
  world.set_threads(threads);
  fill(world);
  std::vector<double> out;
  for (int i = 0; i < substeps; ++i) {
    world.step();
    const world::State state = state_of(world);
    for (const world::LinkState& link : state.links) {
      for (int k = 0; k < 3; ++k) {
        out.push_back(link.pose.position[k]);
        out.push_back(link.velocity[k]);
        out.push_back(link.angular_velocity[k]);
      }
    }
  }
  return out;
}

TEST(Threads, ChangeNoBitOfAWorld) {
  constexpr int substeps = 40;
  const std::vector<double> alone = state_after(1, substeps);
  for (const unsigned threads : {2U, 3U, 8U})
    EXPECT_EQ(state_after(threads, substeps), alone) << threads;
}

TEST(Threads, MayBeMoreAndFewer) {
  World world(with_floor(9.8), 0.01), same(with_floor(9.8), 0.01);
  fill(world);
  fill(same);
  for (const unsigned threads : {3U, 1U, 2U, 5U}) {
    world.set_threads(threads);
    for (int i = 0; i < 5; ++i) world.step(), same.step();
  }
  EXPECT_EQ(world.energy(), same.energy());
}

TEST(Threads, AWatchHasTheStagesOfASubstepAndChangesNoBit) {
  using timing::Phase;
  for (const unsigned threads : {1U, 2U}) {
    World world(with_floor(9.8), 0.01), same(with_floor(9.8), 0.01);
    fill(world);
    fill(same);
    world.set_threads(threads);
    timing::Stopwatch watch(Phase::forces);
    for (int i = 0; i < 30; ++i) world.step(&watch), same.step();
    EXPECT_EQ(world.energy(), same.energy());
    const timing::PhaseTimes times = watch.take();
    for (const Phase stage : {Phase::forces, Phase::contacts, Phase::solve, Phase::integrate})
      EXPECT_GT(times[stage], 0) << threads << " threads, phase " << static_cast<int>(stage);
    EXPECT_DOUBLE_EQ(times.ticks(), times.physics());
  }
}

}  // namespace
}  // namespace ziggurat::physics
