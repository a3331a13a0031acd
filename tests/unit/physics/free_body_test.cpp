// SPDX-License-Identifier: MIT
// Bodies in flight and at rest, against closed forms.

#include <gtest/gtest.h>

#include <cmath>

#include "bench_scene.h"

namespace ziggurat::physics {
namespace {

using namespace testing;
using math::Pose;
using math::Vector3;

const scene::Box small_cube{{0.01, 0.01, 0.01}};

TEST(FreeFall, IsExactOrSemiImplicitEuler) {
  const double h = 0.01, g = 9.8;
  World world(with_gravity(g), h);
  const Pose start{{0.1, -0.2, 5}, about({1, 2, 3}, 0.7)};
  world.add(single(scene::EntityKind::box, start, true, small_cube, 0.25));
  for (int n = 1; n <= 60; ++n) {
    world.step();
    const double z = start.position.z() - fall(g, h, n);
    ASSERT_NEAR(state_of(world).origins[0].position.z(), z, 1e-12) << "substep " << n;
  }
}

TEST(FreeFall, OfAPrototypeIsDampedByTheDialectsLaw) {
  // The solution of dv/dt = g - k v (1 + v), by the midpoint rule in fine steps, to the order of
  // the step.
  double v = 0, fallen = 0;
  World world(with_gravity(9.8), 0.01);
  scene::Entity box = prototype("box", {{0, 0, 1}, math::Quaternion::Identity()}, true,
                                {link("base", scene::Box{{0.1, 0.1, 0.1}}, 1)});
  box.links[0].damping = {0.04, 0.04};
  world.add(box);
  for (int tick = 0; tick < 3; ++tick) {
    for (int i = 0; i < 10; ++i) world.step();
    for (int i = 0; i < 1000; ++i) {
      const double middle = v + 5e-5 * (9.8 - 0.04 * v * (1 + v));
      v += 1e-4 * (9.8 - 0.04 * middle * (1 + middle));
      fallen += 1e-4 * middle;
    }
    EXPECT_NEAR(state_of(world).origins[0].position.z(), 1 - fallen, 5e-4);
  }
}

TEST(Damping, OfASingleBodyFollowsTheSameLaw) {
  // dv/dt = -k v (1 + v) from v0 solves v / (1 + v) = v0 / (1 + v0) exp(-k t).
  World world(with_gravity(9.8), 1e-3);
  scene::Entity box = single(scene::EntityKind::box, {{0, 0, 100}, math::Quaternion::Identity()},
                             true, small_cube, 1);
  box.links[0].damping = {0.5, 0.5};
  world.add(box);
  for (int i = 0; i < 20000; ++i) world.step();
  // Terminal velocity: k v (1 + v) = g.
  const double terminal = (-1 + std::sqrt(1 + 4 * 9.8 / 0.5)) / 2;
  EXPECT_NEAR(-state_of(world).links[0].velocity.z(), terminal, 1e-3);
}

// A step of the law would turn what is that fast round, faster than before.
TEST(Damping, StopsWhatIsFastWithinASubstepAndDoesNotTurnItRound) {
  World world(with_gravity(0), 0.1);
  scene::Entity box = single(scene::EntityKind::box, at(0, 0, 100), true, small_cube, 1);
  box.links[0].damping = {0.5, 0.5};
  world.add(box);
  const double inertia = 1e-4 / 6;
  const world::Push push{0, {1000, 0, 0}, {0, 0, 1000 * inertia}};  // to 100 m/s and rad/s
  set_pushes(world, std::span(&push, 1));
  world.step();
  set_pushes(world, {});
  double speed = 100.001, turning = 100.001;
  for (int i = 0; i < 50; ++i) {
    const world::LinkState link = state_of(world).links[0];
    EXPECT_GE(link.velocity.x(), -1e-9);
    EXPECT_LE(link.velocity.x(), speed);
    EXPECT_GE(link.angular_velocity.z(), -1e-9);
    EXPECT_LE(link.angular_velocity.z(), turning);
    speed = link.velocity.x() + 1e-9, turning = link.angular_velocity.z() + 1e-9;
    world.step();
  }
  EXPECT_LT(speed, 0.3);
}

TEST(Rest, ABoxStandsOnTheFloor) {
  World world(with_floor(9.8), 0.01);
  world.add(single(scene::EntityKind::box, {{0, 0, 0.02}, math::Quaternion::Identity()}, true,
                   small_cube, 0.25));
  for (int i = 0; i < 200; ++i) world.step();
  const world::State state = state_of(world);
  EXPECT_NEAR(state.origins[0].position.z(), 0, 1e-5);
  EXPECT_LT(state.links[0].velocity.norm(), 1e-4);
}

TEST(Rest, ACylinderLiesAtItsRadius) {
  World world(with_floor(9.8), 0.01);
  const scene::Cylinder cylinder{0.005, 0.01};
  world.add(single(scene::EntityKind::cylinder, {{0, 0, 0.02}, about({1, 0, 0}, 1.5)}, true,
                   cylinder, 0.25));
  for (int i = 0; i < 400; ++i) world.step();
  const Pose pose = state_of(world).origins[0];
  EXPECT_NEAR((pose * Vector3(0, 0, 0.005)).z(), 0.005, 5e-5);
}

TEST(Rest, ASphereStopsAtItsRadius) {
  World world(with_floor(9.8), 0.01);
  scene::Entity ball = prototype("ball", {{0, 0, 0.03}, math::Quaternion::Identity()}, true,
                                 {link("base", scene::Sphere{0.02}, 0.1)});
  world.add(ball);
  for (int i = 0; i < 200; ++i) world.step();
  EXPECT_NEAR(state_of(world).origins[0].position.z(), 0, 2e-5);
}

TEST(Rest, ATowerOfFiveBoxesStands) {
  World world(with_floor(9.8), 0.01);
  for (int i = 0; i < 5; ++i) {
    world.add(single(scene::EntityKind::box, {{0, 0, 0.01 * i}, math::Quaternion::Identity()}, true,
                     small_cube, 0.25));
  }
  for (int i = 0; i < 1000; ++i) world.step();
  const world::State state = state_of(world);
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(state.origins[i].position.z(), 0.01 * i, 2e-4) << "box " << i;
    EXPECT_LT(state.origins[i].position.head<2>().norm(), 1e-3) << "box " << i;
  }
}

/// Displacement along the slope after 0.6 s with friction 0.25 (dialect A.3).
/// @param heading  of the fall line about the vertical [rad]
double slide(double degrees, scene::EntityKind kind, double heading = 0) {
  World world(with_gravity(9.8), 0.01);
  const double angle = degrees * EIGEN_PI / 180;
  const math::Quaternion tilt = about({0, 0, 1}, heading) * about({0, 1, 0}, angle);
  scene::Entity ramp =
      single(scene::EntityKind::box, {{0, 0, -0.1}, tilt}, false, scene::Box{{4, 1, 0.1}}, 0);
  const Vector3 up = tilt * Vector3::UnitZ(), downhill = tilt * Vector3::UnitX();
  const Vector3 top = ramp.pose.position + up * 0.1;
  world.add(ramp);
  scene::Entity box =
      prototype("block", {top, tilt}, true, {link("base", scene::Box{{0.05, 0.05, 0.05}}, 0.1)});
  box.kind = kind;
  world.add(box);
  for (int i = 0; i < 60; ++i) world.step();
  return (state_of(world).origins[1].position - top).dot(downhill);
}

TEST(Slopes, BodiesStickOrSlideAccordingToFriction) {
  for (const auto kind : {scene::EntityKind::box, scene::EntityKind::prototype}) {
    EXPECT_LT(slide(13, kind), 1e-4);
    EXPECT_LT(slide(13.9, kind), 2e-4);  // atan(0.25) is 14.04 degrees
    for (const double degrees : {15.0, 20.0}) {
      const double angle = degrees * EIGEN_PI / 180;
      const double acceleration = 9.8 * (std::sin(angle) - 0.25 * std::cos(angle));
      const double expected = acceleration * 0.6 * 0.61 / 2;  // semi-implicit Euler: t (t + h) / 2
      EXPECT_NEAR(slide(degrees, kind), expected, 0.03 * expected + 3e-4) << degrees;
    }
  }
}

TEST(Slopes, ABoxSlidesEquallyInEveryDirection) {
  // Friction is a cone, not a pyramid along the world's axes.
  for (const auto kind : {scene::EntityKind::box, scene::EntityKind::prototype}) {
    const double way = slide(20, kind, 0);
    for (const double heading : {0.4, 0.8, 1.2, 1.5707963267948966}) {
      EXPECT_NEAR(slide(20, kind, heading), way, 0.02 * way) << heading;
    }
  }
}

}  // namespace
}  // namespace ziggurat::physics
