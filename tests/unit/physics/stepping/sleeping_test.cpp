// SPDX-License-Identifier: MIT
// Which islands sleep, and what wakes them.

#include <gtest/gtest.h>

#include <cmath>

#include "../../long_runs.h"
#include "touching.h"

namespace ziggurat::dynamics {
namespace {

using testing::at;
using testing::g;
using testing::Touching;

Touching floor_with(int boxes, double side) {
  Touching world;
  world.planes.push_back({Vector3::Zero(), Vector3::UnitZ()});
  for (int i = 0; i < boxes; ++i) {
    world.add_box(Vector3::Constant(side), 1, at(0, 0, side * (i + 0.5)), 0.7);
  }
  return world;
}

void run(Touching& world, double seconds, double hz) {
  for (int i = 0; i < seconds * hz; ++i) world.step(1 / hz);
}

TEST(Sleeping, ABoxOnTheFloorSleepsAndWakesByAForce) {
  Touching world = floor_with(1, 0.1);
  run(world, 1, 100);
  ASSERT_TRUE(world.system.is_asleep(0));
  EXPECT_EQ(world.step(0.01).awake, 0);
  world.system.apply_wrench(
      0, 0, {Vector3::Zero(), Vector3(0, 0, 1e-4 * g)});  // less than a thousandth of its weight
  EXPECT_EQ(world.step(0.01).awake, 0);
  world.system.apply_wrench(0, 0, {Vector3::Zero(), Vector3(0, 0, 2 * g)});
  EXPECT_EQ(world.step(0.01).awake, 1);
  EXPECT_NEAR(world.tree(0).v[5], g * 0.01, 1e-9);
}

TEST(Sleeping, ABoxInTheAirDoesNotSleep) {
  for (const double hz : long_runs::some_of({100., 4000.})) {
    Touching world;
    world.gravity = Vector3(0, 0, -5e-3);
    world.add_box(Vector3::Constant(0.1), 1, at(0, 0, 10), 0.7);
    run(world, 2, hz);
    EXPECT_NEAR(world.tree(0).v[5], -1e-2, 1e-9) << hz;
  }
}

// 5/7 g sin(0.05 degrees) = 6.1 mm/s^2.
TEST(Sleeping, ABallOnAGentleSlopeRolls) {
  const double radius = 0.05, slope = 0.05 * M_PI / 180;
  for (const double hz : long_runs::some_of({50., 100., 1000., 4000.})) {
    System system;
    Link link;
    link.mass = 0.3;
    link.inertia = Vector3::Constant(0.4 * link.mass * radius * radius);
    system.trees.emplace_back(std::vector<Link>{link}, at(0, 0, radius));
    system.trees[0].gravity = g * Vector3(std::sin(slope), 0, -std::cos(slope));
    std::vector<ContactPoint> contacts(1);
    for (int i = 0; i < 2 * hz; ++i) {
      const Vector3 centre = system.trees[0].position[0];
      contacts[0].a.tree = 0;
      contacts[0].point = Vector3(centre.x(), 0, 0);
      contacts[0].gap = centre.z() - radius;
      contacts[0].friction = 0.5;
      system.step(1 / hz, contacts);
    }
    EXPECT_NEAR(system.trees[0].v[3], 2 * 5. / 7 * g * std::sin(slope), 1e-6) << hz;
  }
}

// A body that a wrench or a servo drives onto a sleeper, without gravity, wakes it before they
// overlap.
TEST(Sleeping, ASleeperWakesByWhatIsAboutToBePushedOntoIt) {
  for (const bool by_servo : {false, true}) {
    Touching world = floor_with(1, 0.1);
    world.planes[0].friction = 0.5;
    run(world, 1, 100);
    ASSERT_TRUE(world.system.is_asleep(0));
    world.add_box(Vector3::Constant(0.1), 1, at(0, 0, 0.1502), 0.7);  // 0.2 mm above
    Tree& tree = world.tree(1);
    if (by_servo) {
      Servo servo;
      servo.tree = 1;
      servo.dof = 5;
      servo.target_velocity = -1;
      servo.lower = -10;
      servo.upper = 10;
      world.servos.push_back(servo);
    } else {
      world.system.apply_wrench(1, 0, {Vector3::Zero(), Vector3(0, 0, -100)});
    }
    world.find(0.01);
    for (Tree& each : world.system.trees) each.gravity.setZero();
    world.system.step(0.01, world.contacts, world.servos);
    EXPECT_GT(tree.position[0].z(), 0.15 - 2e-6) << by_servo;
    EXPECT_FALSE(world.system.is_asleep(0)) << by_servo;
  }
}

TEST(Sleeping, ATowerWakesWhereItIsStruck) {
  Touching world = floor_with(3, 0.05);
  const int ball = world.add_box(Vector3::Constant(0.02), 0.1, at(1, 0, 0.14), 0.5);
  world.gravity = Vector3(0, 0, -g);
  run(world, 1, 100);
  ASSERT_TRUE(world.system.is_asleep(0) && world.system.is_asleep(2));
  world.system.wake(ball);
  world.tree(ball).set_root(at(0.2, 0, 0.13));
  world.tree(ball).v = {0, 0, 0, -2, 0, 0.4};  // strikes the topmost box at its middle
  forward_kinematics(world.tree(ball));
  velocity_kinematics(world.tree(ball));
  int asleep = 0;
  while (world.system.is_asleep(2) && asleep < 100) ++asleep, world.step(0.01);
  EXPECT_GE(asleep, 6);  // 0.2 m - half sides at 2 m/s take 8.25 substeps
  EXPECT_LE(asleep, 9);
  EXPECT_FALSE(world.system.is_asleep(0));
  run(world, 0.1, 100);
  EXPECT_LT(world.tree(2).position[0].x(), -1e-3);
}

/// Points of a foot of 10 cm, on the floor about (x, 0).
void add_foot(double x, double friction, int link, std::vector<ContactPoint>& contacts) {
  for (const double dx : {-0.05, 0.05}) {
    for (const double y : {-0.05, 0.05}) {
      ContactPoint& contact = contacts.emplace_back();
      contact.a = {0, link};
      contact.point = Vector3(x + dx, y, 0);
      contact.friction = friction;
    }
  }
}

/// Checks a body with rotors about z: each turns at the speed commanded after it fell asleep.
void expect_to_wake_by(const std::vector<double>& speeds) {
  System system;
  std::vector<Link> links{testing::box_link({0.1, 0.1, 0.1}, 1)};
  std::vector<Servo> servos;
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    links.push_back(testing::hung(testing::box_link({0.1, 0.1, 0.1}, 1), 0, JointType::revolute,
                                  Vector3::UnitZ(), {0, 0, 0.1}, {0, 0, 0.1}));
    Servo& servo = servos.emplace_back();
    servo.tree = 0, servo.dof = 6 + static_cast<int>(i), servo.lower = -1, servo.upper = 1;
  }
  system.trees.emplace_back(links, at(0, 0, 0.05));
  testing::weigh(system.trees[0]);
  std::vector<ContactPoint> contacts;
  add_foot(0, 0.8, 0, contacts);
  for (int i = 0; i < 100; ++i) system.step(0.01, contacts, servos);
  ASSERT_TRUE(system.is_asleep(0));
  for (std::size_t i = 0; i < speeds.size(); ++i) servos[i].target_velocity = speeds[i];
  system.step(0.01, contacts, servos);
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    EXPECT_NEAR(system.trees[0].v[6 + i], speeds[i], 1e-6);
  }
}

TEST(Sleeping, AServoWakesByItsCommand) { expect_to_wake_by({0.5}); }

// Commands of several are no sum: 1.25 * 0.8 - 1 is 0.
TEST(Sleeping, ServosWakeByTheirCommandsWhateverTheyAre) {
  expect_to_wake_by({0.8, -1});
  expect_to_wake_by({-0.4, 0.5});
}

// Two boxes on a slide, held by friction of 3 N each, and pushed apart by 10 N.
TEST(Sleeping, ForcesOnTwoLinksThatCancelWake) {
  System system;
  const Link box = testing::box_link({0.1, 0.1, 0.1}, 1);
  const Link slider =
      testing::hung(box, 0, JointType::prismatic, Vector3::UnitX(), {0.3, 0, 0}, Vector3::Zero());
  system.trees.emplace_back(std::vector<Link>{box, slider}, at(0, 0, 0.05));
  testing::weigh(system.trees[0]);
  std::vector<ContactPoint> contacts;
  add_foot(0, 0.3, 0, contacts);
  add_foot(0.3, 0.3, 1, contacts);
  for (int i = 0; i < 100; ++i) system.step(0.01, contacts);
  ASSERT_TRUE(system.is_asleep(0));
  system.apply_wrench(0, 0, {Vector3::Zero(), Vector3(-10, 0, 0)});
  system.apply_wrench(0, 1, {Vector3::Zero(), Vector3(10, 0, 0)});
  system.step(0.01, contacts);
  EXPECT_NEAR(system.trees[0].v[6], 2 * (10 - 0.3 * g) * 0.01, 1e-6);
}

// Sleepers are left alone: the bits of what sleeps do not change.
TEST(Sleeping, SleepersKeepTheirBits) {
  Touching world = floor_with(5, 0.05);
  run(world, 2, 100);
  ASSERT_TRUE(world.system.is_asleep(4));
  const std::vector<double> before = world.tree(4).q;
  run(world, 2, 100);
  EXPECT_EQ(world.tree(4).q, before);
}

// An island's bits depend on that island alone.
TEST(Sleeping, AnotherIslandChangesNoBit) {
  const auto fall = [](bool other) {
    Touching world = floor_with(3, 0.05);
    world.tree(2).v = {0.3, 0.2, 1, 0.1, 0.2, 0};
    if (other) {
      world.add_box(Vector3::Constant(0.1), 1, at(50, 0, 0.3), 0.7);
      world.add_box(Vector3::Constant(0.1), 1, at(50, 0.03, 0.5), 0.7);
    }
    run(world, 1, 100);
    return std::pair(world.tree(0).q, world.tree(2).q);
  };
  EXPECT_EQ(fall(false), fall(true));
}

}  // namespace
}  // namespace ziggurat::dynamics
