// SPDX-License-Identifier: MIT
// Limits and servos against closed forms.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "../../long_runs.h"
#include "touching.h"

namespace ziggurat::dynamics {
namespace {

using testing::at;
using testing::g;
using testing::Touching;

/// A load on a vertical slide.
Tree slide(double mass) {
  Link load = testing::hung(testing::box_link({0.2, 0.2, 0.2}, mass), 0, JointType::prismatic,
                            Vector3::UnitZ(), Vector3::Zero(), Vector3::Zero());
  return Tree({testing::ground(), load}, {});
}

TEST(Joint, ALoadThatFallsTwoMetresOnALimitStopsThere) {
  for (const double mass : {1., 100., 1000.}) {
    for (const double hz : long_runs::some_of({50., 100., 1000.})) {
      Touching world;
      world.add(slide(mass), Vector3::Zero(), 0);
      Limit limit;
      limit.tree = 0, limit.link = 1, limit.lower = -2, limit.upper = 0.1;
      world.limits = {limit};
      double lowest = 0, rebound = -2;
      bool stopped = false;
      for (int i = 0; i < 3 * hz; ++i) {
        world.step(1 / hz);
        const double z = world.tree(0).q[0];
        lowest = std::min(lowest, z);
        stopped = stopped || z < -1.999;
        if (stopped) rebound = std::max(rebound, z);
      }
      EXPECT_GT(lowest, -2 - 1e-6);
      EXPECT_LT(rebound, -2 + 1e-6);
      EXPECT_NEAR(world.tree(0).q[0], -2, 1e-6);
    }
  }
}

TEST(Joint, ARodSwingsOntoItsLimit) {
  Touching world;
  world.add(testing::chain(1, 1, 100), Vector3::Zero(), 0);
  Limit limit;
  limit.tree = 0, limit.link = 1, limit.lower = -1, limit.upper = 1;
  world.limits = {limit};
  double most = 0;
  for (int i = 0; i < 300; ++i) {
    world.step(0.01);
    most = std::max(most, world.tree(0).q[0]);
  }
  EXPECT_LT(most, 1 + 1e-6);
  EXPECT_NEAR(world.tree(0).q[0], 1, 1e-6);
}

// It is nearer to the other bound when the substep begins.
TEST(Joint, WhatCrossesMostOfItsRangeInASubstepStopsAtItsLimit) {
  for (const double speed : {100., -100.}) {
    Touching world;
    world.gravity.setZero();
    world.add(slide(2), Vector3::Zero(), 0);
    Limit limit;
    limit.tree = 0, limit.link = 1, limit.lower = -1, limit.upper = 1;
    world.limits = {limit};
    world.tree(0).q[0] = speed < 0 ? 0.2 : -0.2;
    forward_kinematics(world.tree(0));
    world.tree(0).v[0] = 1.4 * speed;
    world.step(0.01);
    EXPECT_NEAR(world.tree(0).q[0], speed < 0 ? -1 : 1, 1e-6);
    EXPECT_EQ(world.limits[0].impulse<0, speed> 0);
  }
}

TEST(Joint, AVelocityServoHoldsItsSpeedUnderLoadUpToItsImpulse) {
  Touching world;
  world.add(slide(2), Vector3::Zero(), 0);
  Servo servo;
  servo.tree = 0, servo.dof = 0, servo.target_velocity = 0.3;
  servo.lower = -0.5, servo.upper = 0.5;
  world.servos = {servo};
  for (int i = 0; i < 100; ++i) world.step(0.01);
  EXPECT_NEAR(world.tree(0).v[0], 0.3, 1e-9);
  EXPECT_NEAR(world.servos[0].impulse, 2 * g * 0.01, 1e-8);
  world.servos[0].lower = -0.1, world.servos[0].upper = 0.1;  // weaker than the weight
  const double before = world.tree(0).v[0];
  for (int i = 0; i < 50; ++i) world.step(0.01);
  EXPECT_NEAR(world.tree(0).v[0] - before, 50 * (0.1 / 2 - g * 0.01), 1e-9);
}

TEST(Joint, TheImpulseOfAServoDoesNotDisplaceWhatOverlaps) {
  // A lift carries a box that overlaps it by 1 mm.
  System system;
  system.solver().options.newton_work = 0;  // displacements by passes
  system.trees.push_back(slide(2));
  system.trees.push_back(testing::box({0.1, 0.1, 0.1}, 1, {{0, 0, 0.1}, {1, 0, 0, 0}}));
  std::vector<ContactPoint> contacts;
  for (const double x : {-0.05, 0.05}) {
    for (const double y : {-0.05, 0.05}) {
      ContactPoint& contact = contacts.emplace_back();
      contact.a = {1, 0}, contact.b = {0, 1};
      contact.point = {x, y, 0.05}, contact.gap = -1e-3, contact.friction = 0.5;
    }
  }
  for (Tree& tree : system.trees) testing::weigh(tree);
  std::vector<Servo> servos(1);
  servos[0].tree = 0, servos[0].dof = 0, servos[0].lower = -10, servos[0].upper = 10;
  system.step(0.01, contacts, servos);
  EXPECT_NEAR(servos[0].impulse, 3 * g * 0.01, 1e-4);
  EXPECT_LT(std::abs(system.trees[0].q[0]), 1e-3);
}

TEST(Joint, DampingIsImplicit) {
  Link load = testing::hung(testing::box_link({0.2, 0.2, 0.2}, 1), 0, JointType::prismatic,
                            Vector3::UnitX(), Vector3::Zero(), Vector3::Zero());
  load.damping = 2;
  Touching world;
  world.add(Tree({testing::ground(), load}, {}), Vector3::Zero(), 0);
  world.gravity.setZero();
  world.tree(0).v[0] = 1;
  for (int i = 0; i < 100; ++i) world.step(0.01);
  EXPECT_NEAR(world.tree(0).v[0], std::exp(-2), 1e-6);
  load.damping = 1e5;  // far stiffer than the substep
  world.tree(0) = Tree({testing::ground(), load}, {});
  world.tree(0).v[0] = 1;
  world.step(0.01);
  EXPECT_LT(std::abs(world.tree(0).v[0]), 0.01);
}

// Pushed without end it goes as far in a substep as the damping lets it: force / damping * length.
TEST(Joint, DampingBalancesAForce) {
  Link load = testing::hung(testing::box_link({0.2, 0.2, 0.2}, 1), 0, JointType::prismatic,
                            Vector3::UnitX(), Vector3::Zero(), Vector3::Zero());
  load.damping = 20;
  for (const double time_step : {0.01, 0.1}) {
    System system;
    system.trees.emplace_back(std::vector<Link>{testing::ground(), load}, math::Pose());
    double before = 0;
    for (int i = 0; i < 200; ++i) {
      before = system.trees[0].q[0];
      system.apply_wrench(0, 1, {Vector3::Zero(), Vector3(3, 0, 0)});
      system.step(time_step, {});
    }
    EXPECT_NEAR((system.trees[0].q[0] - before) / time_step, 3.0 / 20, 1e-6) << time_step;
  }
}

// Nothing outside: linear and angular momentum of a robot whose servos turn its arms.
TEST(Joint, ServosKeepTheMomentum) {
  std::vector<Link> links{testing::box_link({0.2, 0.1, 0.05}, 3)};
  links.push_back(testing::hung(testing::box_link({0.3, 0.02, 0.02}, 0.5), 0, JointType::revolute,
                                {0, 0.6, 0.8}, {0.1, 0, 0}, {0.15, 0, 0}));
  links.push_back(testing::hung(testing::box_link({0.3, 0.02, 0.02}, 0.5), 1, JointType::revolute,
                                {1, 0, 0}, {0.15, 0, 0}, {0, 0.1, 0.05}));
  Touching world;
  world.gravity.setZero();
  world.add(Tree(links, {}), Vector3::Zero(), 0);
  for (int dof : {6, 7}) {
    Servo servo;
    servo.tree = 0, servo.dof = dof, servo.target_velocity = dof - 5, servo.lower = -1,
    servo.upper = 1;
    world.servos.push_back(servo);
  }
  const auto momentum = [&] {
    const Tree& tree = world.tree(0);
    Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();
    for (int i = 0; i < 3; ++i) {
      const Link& link = tree.links[i];
      const Matrix3& r = tree.rotation[i];
      linear += link.mass * tree.velocity(i);
      angular += link.mass * tree.position[i].cross(tree.velocity(i));
      angular += r * (r.transpose() * tree.angular_velocity(i)).cwiseProduct(link.inertia);
    }
    return std::max(linear.norm(), angular.norm());
  };
  for (int i = 0; i < 300; ++i) world.step(0.01);
  EXPECT_LT(momentum(), 1e-10);
  EXPECT_NEAR(world.tree(0).v[6], 1, 1e-6);
  EXPECT_NEAR(world.tree(0).v[7], 2, 1e-6);
}

}  // namespace
}  // namespace ziggurat::dynamics
