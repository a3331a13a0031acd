// SPDX-License-Identifier: MIT
// One contact point at a time: impacts, rolling and spinning friction; roots with fewer freedoms;
// servos along a direction.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../../long_runs.h"
#include "physics/stepping/system.h"
#include "step_with_impacts.h"
#include "trees.h"

namespace ziggurat::dynamics {
namespace {

using testing::g;
using testing::step_with_impacts;

constexpr double radius = 0.05, mass = 0.3;  // of the ball [m], [kg]

/// A ball on a floor that may slope along x.
struct Ball {
  System system;
  std::vector<ContactPoint> contacts;
  std::vector<Servo> servos;
  std::vector<Limit> limits;
  ContactPoint law;  // coefficients
  double slope = 0;

  explicit Ball(double height) {
    Link link;
    link.mass = mass;
    link.inertia = Vector3::Constant(0.4 * mass * radius * radius);
    system.trees.emplace_back(std::vector<Link>{link},
                              math::Pose{Vector3(0, 0, height), Quaternion::Identity()});
  }
  Tree& tree() { return system.trees[0]; }
  void find(double time) {
    ContactPoint contact = law;
    contact.a.tree = 0;
    const Vector3& centre = tree().position[0];
    contact.point = Vector3(centre.x(), centre.y(), 0);
    contact.gap = centre.z() - radius;
    if (!contacts.empty()) {
      contact.impulse = contacts[0].impulse;
      contact.carried = !contact.impulse.isZero(0);
      contact.angular_impulse = contacts[0].angular_impulse;
    }
    contacts.clear();
    const double reach = 1e-3 + 2 * time * tree().velocity(0).norm();
    if (contact.gap < reach) contacts.push_back(contact);
  }
  void step(double time_step) {
    tree().gravity = g * Vector3(std::sin(slope), 0, -std::cos(slope));
    const Report report = step_with_impacts(system, time_step, contacts, servos, limits,
                                            [&](double time) { find(time); });
    EXPECT_EQ(report.not_converged, 0);
  }
  void roll(double speed) {
    tree().v[3] = speed, tree().v[1] = speed / radius;
    velocity_kinematics(tree());
  }
};

// A rebound rises to the square of the restitution times the height of the fall, at any time of the
// impact in a substep: both falls are exact.
TEST(Friction, ABallBouncesAsHighAsItsRestitutionSays) {
  for (const double restitution : {0.5, 1.}) {
    for (const double hz : long_runs::some_of({50., 100., 1000.})) {
      for (const double fall : {0.05, 0.37, 1.}) {
        Ball ball(radius + fall);
        ball.law.restitution = restitution;
        double rise = 0;  // where the parabola that the ball is on has its top
        bool rebounds = false;
        for (int i = 0; i < hz; ++i) {
          ball.step(1 / hz);
          const double speed = ball.tree().v[5];
          if (rebounds && speed < 0) break;
          rebounds = rebounds || speed > 0;
          rise = ball.tree().position[0].z() - radius + speed * speed / (2 * g);
        }
        EXPECT_NEAR(rise / (restitution * restitution * fall), 1, 1e-8) << restitution << " " << hz;
      }
    }
  }
}

// Over many rebounds, too, no height is gained.
TEST(Friction, ABallThatLosesNothingBouncesForAMinute) {
  for (const double hz : long_runs::some_of({50., 200.})) {
    Ball ball(radius + 0.3);
    ball.law.restitution = 1;
    for (int i = 0; i < 60 * hz; ++i) {
      ball.step(1 / hz);
      const double speed = ball.tree().v[5];
      const double top = ball.tree().position[0].z() - radius + speed * speed / (2 * g);
      ASSERT_NEAR(top, 0.3, 1e-6) << hz << " " << i;
    }
  }
}

// (m + I / r^2) a = -lever m g / r, with I = 2/5 m r^2.
TEST(Friction, RollingFrictionStopsABall) {
  const double lever = 1e-3, speed = 0.5;
  const double deceleration = 5. / 7 * lever * g / radius;
  for (const double hz : long_runs::some_of({100., 1000.})) {
    Ball ball(radius);
    ball.law.friction = 0.5;
    ball.law.rolling_friction = lever;
    ball.roll(speed);
    for (int i = 0; i < hz; ++i) ball.step(1 / hz);
    EXPECT_NEAR(ball.tree().v[3], speed - deceleration, 1e-5 * speed) << hz;
    const double height =
        ball.tree().position[0].z();  // less than the radius by what its weight presses in
    EXPECT_NEAR(height, radius, 1e-7) << hz;
    EXPECT_NEAR(ball.tree().v[1] * height, ball.tree().v[3], 1e-8) << hz;
    for (int i = 0; i < 4 * hz; ++i) ball.step(1 / hz);
    const double distance = speed * speed / (2 * deceleration);
    EXPECT_NEAR(ball.tree().position[0].x(), distance, 1.1 * speed / hz) << hz;
    EXPECT_LT(ball.tree().velocity(0).norm(), 1e-8) << hz;
  }
}

// A ball stays where the slope's tangent is less than lever / radius.
TEST(Friction, RollingFrictionHoldsABallOnASlope) {
  for (const double share : {0.95, 1.05}) {
    Ball ball(radius);
    ball.law.friction = 0.5;
    ball.law.rolling_friction = 1e-3;
    ball.slope = std::atan(share * ball.law.rolling_friction / radius);
    for (int i = 0; i < 1000; ++i) ball.step(0.01);
    const double x = ball.tree().position[0].x();
    if (share < 1) {
      EXPECT_LT(std::abs(x), 1e-6);
    } else {
      const double a = 5. / 7 * g * std::cos(ball.slope) *
                       (std::tan(ball.slope) - ball.law.rolling_friction / radius);
      EXPECT_NEAR(x / (a * 100 / 2), 1, 2e-3);
    }
  }
}

// I dw/dt = -lever m g.
TEST(Friction, SpinningFrictionStopsATurningBall) {
  const double lever = 1e-4, spin = 3;
  Ball ball(radius);
  ball.law.friction = 0.5;
  ball.law.spinning_friction = lever;
  ball.tree().v[2] = spin;
  velocity_kinematics(ball.tree());
  const double deceleration = lever * mass * g / (0.4 * mass * radius * radius);
  for (int i = 0; i < 100; ++i) ball.step(0.01);
  EXPECT_NEAR(ball.tree().v[2], spin - deceleration, 1e-6);
  for (int i = 0; i < 400; ++i) ball.step(0.01);
  EXPECT_NEAR(ball.tree().v[2], 0, 1e-8);
}

TEST(Freedom, AnUprightBodyTurnsAboutTheVerticalOnly) {
  System system;
  system.trees.emplace_back(std::vector<Link>{testing::box_link({0.2, 0.1, 0.3}, 2)}, math::Pose{},
                            upright_freedoms);
  Tree& tree = system.trees[0];
  ASSERT_EQ(tree.dofs, 4);
  tree.external[0] = {Vector3(5, -3, 0.01), Vector3(1, 0, 2)};
  for (int i = 0; i < 100; ++i) system.step(0.01, {});
  const double inertia = tree.links[0].inertia.z();
  EXPECT_NEAR(tree.v[0], 0.01 / inertia, 1e-9);
  EXPECT_NEAR(tree.v[1], 0.5, 1e-9);
  EXPECT_NEAR(tree.v[3], 1, 1e-9);
  EXPECT_NEAR(tree.rotation[0](2, 2), 1, 1e-12);
}

TEST(Freedom, APlanarBodyKeepsItsHeight) {
  System system;
  system.trees.emplace_back(std::vector<Link>{testing::box_link({0.2, 0.1, 0.3}, 2)},
                            math::Pose{Vector3(0, 0, 0.7), Quaternion::Identity()},
                            planar_freedoms);
  Tree& tree = system.trees[0];
  ASSERT_EQ(tree.dofs, 3);
  testing::weigh(tree);
  tree.external[0] = {Vector3(5, -3, 0), Vector3(1, -2, 2)};
  for (int i = 0; i < 100; ++i) system.step(0.01, {});
  EXPECT_NEAR(tree.v[1], 0.5, 1e-9);
  EXPECT_NEAR(tree.v[2], -1, 1e-9);
  EXPECT_EQ(tree.position[0].z(), 0.7);
}

TEST(Servo, PushesALinkAlongADirectionUpToItsImpulse) {
  System system;
  system.trees.push_back(testing::box({0.2, 0.1, 0.3}, 2, {}));
  std::vector<Servo> servos(2);
  for (Servo& servo : servos) servo.tree = 0, servo.lower = -0.01, servo.upper = 0.01;
  servos[0].direction.linear = Vector3(0.6, 0.8, 0);
  servos[0].target_velocity = 0.2;
  servos[1].direction.angular = Vector3::UnitZ();
  servos[1].target_velocity = 0.1;
  servos[1].lower = -1, servos[1].upper = 1;
  for (int i = 0; i < 20; ++i) system.step(0.01, {}, servos);
  EXPECT_NEAR(system.trees[0].velocity(0).norm(), 20 * 0.01 / 2, 1e-9);
  EXPECT_NEAR(system.trees[0].angular_velocity(0).z(), 0.1, 1e-9);
  for (int i = 0; i < 50; ++i) system.step(0.01, {}, servos);
  EXPECT_NEAR(system.trees[0].velocity(0).x(), 0.2 * 0.6, 1e-8);
  EXPECT_NEAR(system.trees[0].velocity(0).y(), 0.2 * 0.8, 1e-8);
}

// A servo for a position is one for a speed whose caller seeks the place within the substep.
TEST(Servo, HoldsAPositionUnderLoad) {
  Link load = testing::hung(testing::box_link({0.2, 0.2, 0.2}, 2), 0, JointType::prismatic,
                            Vector3::UnitZ(), Vector3::Zero(), Vector3::Zero());
  System system;
  system.trees.emplace_back(std::vector<Link>{testing::ground(), load}, math::Pose{});
  testing::weigh(system.trees[0]);
  std::vector<Servo> servos(1);
  servos[0].tree = 0, servos[0].dof = 0, servos[0].lower = -10, servos[0].upper = 10;
  for (int i = 0; i < 200; ++i) {
    servos[0].target_velocity = std::clamp((0.3 - system.trees[0].q[0]) / 0.01, -0.5, 0.5);
    system.step(0.01, {}, servos);
  }
  EXPECT_NEAR(system.trees[0].q[0], 0.3, 1e-9);
  EXPECT_NEAR(servos[0].impulse, 2 * g * 0.01, 1e-7);
}

// Impulses of an island do not depend on the order of its contacts.
TEST(Island, TheOrderOfContactsChangesNoBit) {
  const auto run = [](bool reversed) {
    System system;
    for (int i = 0; i < 2; ++i) {
      system.trees.push_back(testing::box({0.1, 0.1, 0.1}, 1,
                                          {Vector3(0, 0, 0.05 + 0.1 * i), Quaternion::Identity()}));
      testing::weigh(system.trees[i]);
      system.trees[i].v = {0, 0.3, 0.2, 0.4 + i, 0.1, 0};
      velocity_kinematics(system.trees[i]);
    }
    std::vector<ContactPoint> contacts;
    for (int i = 0; i < 2; ++i) {
      for (const double x : {-0.05, 0.05}) {
        for (const double y : {-0.05, 0.05}) {
          ContactPoint contact;
          contact.a.tree = i, contact.b.tree = i - 1;
          contact.point = Vector3(x, y, 0.1 * i);
          contact.friction = 0.4;
          contacts.push_back(contact);
        }
      }
    }
    if (reversed) std::reverse(contacts.begin(), contacts.end());
    system.step(0.01, contacts);
    return std::pair(system.trees[0].q, system.trees[1].v);
  };
  EXPECT_EQ(run(false), run(true));
}

}  // namespace
}  // namespace ziggurat::dynamics
