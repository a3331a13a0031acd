// SPDX-License-Identifier: MIT
// Flat bodies that fall, turn and strike: no corner goes into what stands.

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "../long_runs.h"
#include "math/random.h"
#include "newton_scene.h"

namespace ziggurat::physics {
namespace {

using namespace testing;

/// Depth of the lowest corner of a box below z = 0 [m].
/// @param pose  of the middle of its lower side
double depth(const Pose& pose, const Vector3& size) {
  const double centre = (pose * Vector3(0, 0, size.z() / 2)).z();
  return pose.orientation.toRotationMatrix().row(2).cwiseAbs().dot(size) / 2 - centre;
}

math::Quaternion any_turn(math::RandomStream& random) {
  math::Quaternion out{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1),
                       random.uniform(-1, 1)};
  return out.normalized();
}

/// Depth of the deepest corner of boxes below z = 0 [m].
/// @param sizes  of the first of the world's bodies, which are boxes
double worst_depth(World& world, const std::vector<Vector3>& sizes, int substeps) {
  double worst = 0;
  for (int n = 0; n < substeps; ++n) {
    world.step();
    const world::State state = state_of(world);
    for (std::size_t i = 0; i < sizes.size(); ++i)
      worst = std::max(worst, depth(state.origins[i], sizes[i]));
  }
  return worst;
}

TEST(NewtonPlanks, LieOnTheFloorWhereTheyFell) {
  math::RandomStream random(7, "planks");
  World world(newton(true), 0.01);
  std::vector<Vector3> sizes;
  for (int i = 0; i < 200; ++i) {
    sizes.push_back(
        {random.uniform(0.02, 0.22), random.uniform(0.01, 0.06), random.uniform(0.004, 0.024)});
    const Pose pose{{0.5 * (i % 15), 0.5 * (i / 15), random.uniform(0.2, 0.4)}, any_turn(random)};
    world.add(loose(pose, scene::Box{sizes.back()}, 1000 * sizes.back().prod()));
  }
  EXPECT_LT(worst_depth(world, sizes, 300), 5e-4);
}

// Corners of a spinning plank rotate by half a radian in a substep, about an axis that rotates,
// too. Where a straight path or a fixed axis passed the floor, it was not there.
TEST(NewtonPlanks, ThatAreSpunDoNotGoIntoTheFloor) {
  const Vector3 size(0.3, 0.08, 0.02);
  constexpr double mass = 0.3, h = 0.01;
  constexpr std::size_t count = 200;
  math::RandomStream random(7, "planks");
  World world(newton(true), h);
  std::vector<world::Push> pushes;
  for (std::size_t i = 0; i < count; ++i) {
    const Pose pose{{0, 2.0 * static_cast<double>(i), random.uniform(0.3, 0.5)}, any_turn(random)};
    scene::Entity plank = loose(pose, scene::Box{size}, mass);
    plank.id += std::to_string(i);
    world.add(plank);
    const Vector3 squares = size.cwiseAbs2(),
                  inertia = mass / 12 * (Vector3::Constant(squares.sum()) - squares);
    const Vector3 spin{random.uniform(-30, 30), random.uniform(-30, 30),
                       random.uniform(-30, 30)};  // in the plank's axes [rad/s]
    pushes.push_back(
        {i, Vector3(0, 0, -mass * 3 / h), pose.orientation * inertia.cwiseProduct(spin) / h});
  }
  set_pushes(world, pushes);
  world.step();
  set_pushes(world, {});
  double worst = 0;
  for (int n = 0; n < 60; ++n) {
    world.step();
    const world::State state = state_of(world);
    for (const Pose& pose : state.origins) worst = std::max(worst, depth(pose, size));
  }
  EXPECT_LT(worst, 5e-4);
}

// One end strikes a row of boxes, and the other one is thrown down within the same substep. Rows of
// more than seven were not looked at, so that the floor was beyond its reach.
TEST(NewtonPlanks, OneIsThrownDownByARowOfBoxes) {
  const Vector3 size(0.3, 0.08, 0.02);
  const double top = 0.06;
  for (const int boxes : {1, 7, 12}) {
    for (const double gap : {0.001, 0.002, 0.004}) {
      World world(newton(true), 0.01);
      for (int i = 0; i < boxes; ++i)
        world.add(loose(at(-0.15 - 0.1 * i, 0, 0), scene::Box{{0.1, 0.1, top}}, 5));
      world.add(
          loose(at(0, 0, top + gap + earth / 8), scene::Box{size}, 0.3));  // half a second above
      double worst = 0;
      for (int n = 0; n < 100; ++n) {
        world.step();
        worst = std::max(worst, depth(state_of(world).origins.back(), size));
      }
      EXPECT_LT(worst, 5e-4) << boxes << ' ' << gap;
    }
  }
}

// Two hundred that fall on each other.
TEST(NewtonPlanks, InAHeapDoNotGoIntoTheFloor) {
  if (long_runs::is_slow) return;
  const Vector3 size(0.3, 0.08, 0.02);
  math::RandomStream random(7, "planks");
  World world(newton(true), 0.01);
  for (int i = 0; i < 200; ++i) {
    const Pose pose{{0.4 * (i % 7), 0.4 * (i / 7 % 7), 0.3 + 0.4 * (i / 49)}, any_turn(random)};
    world.add(loose(pose, scene::Box{size}, 0.3));
  }
  double worst = 0;
  for (int n = 0; n < 120; ++n) {
    world.step();
    for (const Pose& pose : state_of(world).origins) worst = std::max(worst, depth(pose, size));
  }
  EXPECT_LT(worst, 5e-4);
}

// Planks of many sizes: light ones that lie still are struck so that they turn far, and overlaps of
// others push them.
TEST(NewtonPlanks, OfManySizesInAHeapDoNotGoIntoTheFloor) {
  if (long_runs::is_slow) return;
  for (const int seed : {2, 18}) {
    math::RandomStream random(seed, "planks");
    World world(newton(true), 0.01);
    std::vector<Vector3> sizes;
    for (int i = 0; i < 200; ++i) {
      sizes.push_back(
          {random.uniform(0.1, 0.4), random.uniform(0.03, 0.1), random.uniform(0.008, 0.03)});
      const Pose pose{{0.45 * (i % 7), 0.45 * (i / 7 % 7), 0.35 + 0.45 * (i / 49)},
                      any_turn(random)};
      world.add(loose(pose, scene::Box{sizes.back()}, 600 * sizes.back().prod()));
    }
    EXPECT_LT(worst_depth(world, sizes, 120), 5e-4) << seed;
  }
}

// A heavy box overlaps a light one by 20 mm, which hovers 5 mm above the floor. 16 mm are resolved,
// beyond the floor, which nothing approaches.
TEST(NewtonPlanks, OneThatAnOverlapPushesDownDoesNotGoIntoTheFloor) {
  World world(newton(true), 0.01);
  const Vector3 size(0.3, 0.08, 0.02);
  world.add(loose(at(0, 0, 0.005), scene::Box{size}, 0.1));
  world.add(loose(at(0, 0, 0.005), scene::Box{{0.3, 0.3, 0.3}}, 50));
  EXPECT_LT(worst_depth(world, {size}, 20), 5e-4);
}

}  // namespace
}  // namespace ziggurat::physics
