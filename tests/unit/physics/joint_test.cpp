// SPDX-License-Identifier: MIT
// Joints and motors against closed forms.

#include <gtest/gtest.h>

#include <cmath>

#include "bench_scene.h"

namespace ziggurat::physics {
namespace {

using namespace testing;
using math::Pose;
using math::Vector3;

const Pose identity;

/// A fixed base in the air and one child on a joint.
scene::Entity pair(const scene::Joint& joint, const scene::Geometry& child, double mass) {
  scene::Entity entity =
      prototype("pair", at(0, 0, 10), false,
                {link("base", scene::Box{{0.02, 0.02, 0.02}}, 1), link("child", child, mass)});
  entity.joints.push_back(joint);
  return entity;
}

TEST(Revolute, APendulumSwingsInItsClosedFormPeriod) {
  // A 0.1 m cube hangs with its centre 0.5 m below an axis along y.
  const double length = 0.5, mass = 2, g = 9.8, h = 0.001;
  World world(with_gravity(g), h);
  const Pose hung = at(0, 0, 0.05 + length);  // the axis seen from the cube's bottom centre
  scene::Joint swing = joint(scene::JointType::revolute, Vector3::UnitY(),
                             {{0, 0, 0}, about({0, 1, 0}, 0.05)}, hung);
  world.add(pair(swing, cube, mass));
  const JointIndex axis = world.joint(0, 0);
  // Falling from the angle at which it was assembled, q runs from 0 to -2 * 0.05 and back.
  double first = 0, last = 0, previous = 0;
  int crossings = 0;
  for (int n = 1; crossings < 5 && n < 20000; ++n) {
    world.step();
    const double angle = world.position(axis) + 0.05;
    if (n > 1 && previous > 0 && angle <= 0) {
      const double time = h * (n - angle / (angle - previous));
      if (crossings == 0) first = time;
      last = time;
      ++crossings;
    }
    previous = angle;
  }
  const double inertia = mass * 0.01 / 6 + mass * length * length;
  const double period =
      2 * EIGEN_PI * std::sqrt(inertia / (mass * g * length)) * (1 + 0.05 * 0.05 / 16);
  EXPECT_EQ(crossings, 5);
  EXPECT_NEAR((last - first) / 4, period, 0.005 * period);
}

TEST(Revolute, PositiveIsRightHandedAboutTheChildsAxis) {
  World world(empty_space(), 0.001);
  world.add(pair(joint(scene::JointType::revolute, Vector3::UnitZ(), identity, identity), cube, 1));
  const JointIndex axis = world.joint(0, 0);
  world.add_motor(axis, scene::JointMode::velocity, 1);
  world.set_target(axis, 1);
  for (int n = 0; n < 100; ++n) world.step();
  EXPECT_NEAR(world.position(axis), 0.1, 1e-3);
  const Vector3 turned = state_of(world).links[1].pose.orientation * Vector3::UnitX();
  EXPECT_NEAR(std::atan2(turned.y(), turned.x()), world.position(axis), 1e-9);
}

TEST(Prismatic, StopsAtItsLimits) {
  for (const double direction : {1.0, -1.0}) {
    World world(empty_space(), 0.01);
    scene::Joint slide = joint(scene::JointType::prismatic, Vector3::UnitX(), identity, identity);
    slide.limit = scene::JointLimit{-0.1, 0.2};
    world.add(pair(slide, cube, 0.5));
    const JointIndex rail = world.joint(0, 0);
    world.add_motor(rail, scene::JointMode::velocity, 0.01);  // 1 N
    world.set_target(rail, direction * 0.5);
    for (int n = 0; n < 300; ++n) {
      world.step();
      ASSERT_LT(world.position(rail), 0.2 + 1e-3);
      ASSERT_GT(world.position(rail), -0.1 - 1e-3);
    }
    EXPECT_NEAR(world.position(rail), direction > 0 ? 0.2 : -0.1, 1e-3);
  }
}

TEST(Prismatic, AMotorDoesNotExceedItsImpulse) {
  // Dialect A.4: 0.5 kg against 4.9 N; after one substep of 10 ms.
  const std::pair<double, double> cases[] = {
      {0.0001, -0.0978}, {0.01, -0.0780}, {0.04, -0.0180}, {0.06, 0}};
  for (const auto& [impulse, velocity] : cases) {
    World world(with_gravity(9.8), 0.01);
    world.add(
        pair(joint(scene::JointType::prismatic, Vector3::UnitZ(), identity, identity), cube, 0.5));
    const JointIndex lift = world.joint(0, 0);
    world.add_motor(lift, scene::JointMode::velocity, impulse);
    world.step();
    EXPECT_NEAR(world.velocity(lift), velocity, 1e-4) << impulse;
  }
}

TEST(Prismatic, ALiftRisesOrStallsAccordingToItsImpulse) {
  for (const double factor : {0.95, 1.05}) {
    World world(with_gravity(9.8), 0.01);
    world.add(
        pair(joint(scene::JointType::prismatic, Vector3::UnitZ(), identity, identity), cube, 0.5));
    const JointIndex lift = world.joint(0, 0);
    world.add_motor(lift, scene::JointMode::velocity, factor * 0.5 * 9.8 * 0.01);
    world.set_target(lift, 0.1);
    for (int n = 0; n < 100; ++n) world.step();
    EXPECT_EQ(world.position(lift) > 0, factor > 1);
  }
}

TEST(Prismatic, MaxSubstepKeepsTheMeanForce) {
  // The mean force is the same with and without a smaller internal substep.
  for (const double refine : {0.01, 0.003, 0.001}) {
    scene::Physics physics = with_gravity(0);
    physics.max_substep = refine;
    World world(physics, 0.01);
    world.add(
        pair(joint(scene::JointType::prismatic, Vector3::UnitX(), identity, identity), cube, 0.5));
    const JointIndex rail = world.joint(0, 0);
    world.add_motor(rail, scene::JointMode::velocity, 0.002);
    world.set_target(rail, 10);
    for (int n = 0; n < 50; ++n) world.step();
    EXPECT_NEAR(world.velocity(rail), 50 * 0.002 / 0.5, 1e-9) << refine;
  }
}

TEST(PositionMode, ReachesItsTargetInOneSubstepIfTheForceSuffices) {
  World world(with_gravity(9.8), 0.01);
  world.add(
      pair(joint(scene::JointType::prismatic, Vector3::UnitZ(), identity, identity), cube, 0.5));
  const JointIndex lift = world.joint(0, 0);
  world.add_motor(lift, scene::JointMode::position, 10);
  world.set_target(lift, 0.05);
  world.step();
  EXPECT_NEAR(world.position(lift), 0.05, 1e-9);
}

TEST(PositionMode, ReachesAndHoldsItsTargetAgainstGravityWithABindingLimit) {
  // Dialect A.5's limit of 0.2 N s overshoots in the reference; ours brakes in time.
  for (const double impulse : {0.2, 0.1}) {
    World world(with_gravity(9.8), 0.01);
    world.add(
        pair(joint(scene::JointType::prismatic, Vector3::UnitZ(), identity, identity), cube, 0.5));
    const JointIndex lift = world.joint(0, 0);
    world.add_motor(lift, scene::JointMode::position, impulse);
    world.set_target(lift, 0.05);
    double highest = 0;
    for (int n = 0; n < 200; ++n) {
      world.step();
      highest = std::max(highest, world.position(lift));
    }
    EXPECT_NEAR(world.position(lift), 0.05, 1e-6) << impulse;
    EXPECT_LT(highest, 0.051) << impulse;
  }
}

TEST(Fixed, StaysRigidUnderLoad) {
  // A 0.5 m arm of 1 kg welded to the world at one end.
  World world(with_gravity(9.8), 0.01);
  const scene::Box arm{{0.5, 0.02, 0.02}};
  world.add(
      pair(joint(scene::JointType::fixed, Vector3::UnitZ(), identity, at(-0.25, 0, 0)), arm, 1));
  const Vector3 before = state_of(world).links[1].pose * Vector3(0.25, 0, 0);
  for (int n = 0; n < 1000; ++n) world.step();
  EXPECT_LT((state_of(world).links[1].pose * Vector3(0.25, 0, 0) - before).norm(), 1e-4);
}

TEST(Fixed, FramesPlaceTheChild) {
  // Dialect 2.3: R_c = R_p R_P R_C^-1, p_c = p_p + R_p t_P - R_c t_C.
  World world(empty_space(), 0.01);
  const Pose parent{{0.3, -0.1, 0.2}, about({1, 0, 2}, 0.8)},
      child{{0.05, 0.02, -0.4}, about({0, 3, 1}, -1.1)};
  scene::Entity entity = prototype("pair", {{1, 2, 3}, about({0, 1, 1}, 0.4)}, true,
                                   {link("base", cube, 1), link("child", cube, 1)});
  entity.joints.push_back(joint(scene::JointType::fixed, Vector3::UnitZ(), parent, child));
  world.add(entity);
  const auto expect_frames_meet = [&] {
    const world::State state = state_of(world);
    const Pose in_parent = state.links[0].pose * parent, in_child = state.links[1].pose * child;
    EXPECT_LT((in_parent.position - in_child.position).norm(), 1e-9);
    EXPECT_LT(in_parent.orientation.angularDistance(in_child.orientation), 1e-7);
  };
  expect_frames_meet();
  for (int n = 0; n < 10; ++n) world.step();
  expect_frames_meet();
}

TEST(Spherical, APendulumConservesItsEnergy) {
  // A rod on a ball joint, swinging out of plane, for 10 s at 1 ms.
  World world(with_gravity(9.8), 0.001);
  const scene::Cylinder rod{0.01, 0.4};
  scene::Joint ball = joint(scene::JointType::spherical, Vector3::UnitZ(),
                            {{0, 0, 0}, about({1, 0.3, 0}, 2.2)}, identity);
  world.add(pair(ball, rod, 0.3));
  const double start = world.energy();
  const double range = 0.3 * 9.8 * 0.2;  // of the potential energy [J]
  for (int n = 0; n < 10000; ++n) {
    world.step();
    ASSERT_NEAR(world.energy(), start, 0.01 * range) << n;
  }
}

TEST(Spherical, KeepsItsPivot) {
  World world(with_gravity(9.8), 0.01);
  const scene::Cylinder rod{0.01, 0.4};
  world.add(pair(joint(scene::JointType::spherical, Vector3::UnitZ(),
                       {{0, 0, 0}, about({1, 0, 0}, 2)}, identity),
                 rod, 0.3));
  for (int n = 0; n < 500; ++n) world.step();
  EXPECT_LT((state_of(world).links[1].pose.position - Vector3(0, 0, 10)).norm(), 1e-9);
}

}  // namespace
}  // namespace ziggurat::physics
