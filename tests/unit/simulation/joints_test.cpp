// SPDX-License-Identifier: MIT
// Joints that are put to a position and a speed.

#include "simulation/joints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>

#include "small_scene.h"

namespace ziggurat::simulation {
namespace {

using math::Vector3;

constexpr double length = 0.5, width = 0.1, mass = 0.3;  // of a rod [m], [kg]
/// Moment of inertia of a rod about its upper end [kg m^2].
constexpr double inertia =
    mass * (length * length + width * width) / 12 + mass * length * length / 4;

std::string rod_link(const std::string& id) {
  return "<link id=\"" + id +
         R"(" geometry="box" size=".1,.1,.5" mass="0.3" linear_damping="0" angular_damping="0"/>)";
}

/// A rod hung by its upper end, whose frame is at its lower one.
std::string hinge(const std::string& id, const std::string& parent, const std::string& child,
                  const std::string& at, const std::string& more = {}) {
  return "<joint id=\"" + id + R"(" type="revolute" axis="0,1,0")" + more + "><parent link=\"" +
         parent + "\" position=\"" + at + "\"/><child link=\"" + child +
         R"(" position="0,0,.5"/></joint>)";
}

/// Two rods below a base at a height of 3 m, a slide, a plate that is fixed, and a ball on a
/// spherical joint.
std::string hanging_machine(const std::string& body = R"(movable="false")") {
  return R"(<prototype id="p" )" + body + R"(><body position="1,2,3"/><links ref="base">)" +
         R"(<link id="base" geometry="box" size=".1,.1,.1" mass="1" linear_damping="0" angular_damping="0"/>)" +
         rod_link("upper") + rod_link("lower") +
         R"(<link id="cart" geometry="box" size=".1,.1,.1" mass="0.1"/>)" +
         R"(<link id="plate" geometry="box" size=".1,.1,.1" mass="0.1"/><link id="ball" geometry="sphere" radius=".05" mass=".1"/>)" +
         R"(</links><joints>)" + hinge("shoulder", "base", "upper", "0,0,0") +
         hinge("elbow", "upper", "lower", "0,0,0") +
         R"(<joint id="slide" type="prismatic" axis="0,1,0" limit="-.2:.7"><parent link="base" position="0,.3,0"/>)"
         R"(<child link="cart" position="0,0,0"/></joint><joint id="weld" type="fixed"><parent link="base" position="0,-.3,0"/>)"
         R"(<child link="plate" position="0,0,0"/></joint><joint id="socket" type="spherical"><parent link="base" position="0,-.6,0"/>)"
         R"(<child link="ball" position="0,0,0"/></joint></joints></prototype>)";
}

std::string hanging_rod() {
  return R"(<prototype id="p" movable="false"><body position="0,0,3"/><links ref="base">)"
         R"(<link id="base" geometry="box" size=".1,.1,.1" mass="1"/>)" +
         rod_link("upper") + R"(</links><joints>)" + hinge("shoulder", "base", "upper", "0,0,0") +
         "</joints></prototype>";
}

testing::SmallScene scene_of(const std::string& arena) {
  return {"", "", arena, R"(<gravity g="9.8"/>)"};
}

/// The angle of a rod that hangs at 0 about +y, from its state.
double angle_of(const world::LinkState& link) {
  const Vector3 down = link.pose.orientation * -Vector3::UnitZ();
  return std::atan2(-down.x(), -down.z());
}

/// The time of a swing to and fro from rest [s]: 2 pi sqrt(I / (m g d)) by the arithmetic-geometric
/// mean of 1 and cos(angle / 2).
double period(double angle) {
  double a = 1, b = std::cos(angle / 2);
  for (int i = 0; i < 10; ++i) std::tie(a, b) = std::pair((a + b) / 2, std::sqrt(a * b));
  return 2 * std::numbers::pi * std::sqrt(inertia / (mass * testing::g * length / 2)) / a;
}

TEST(SetJoint, APendulumSwingsInTheTimeAndWithTheEnergyOfItsAngle) {
  for (const double angle : {0.3, 1.5, -2.8}) {
    Simulation world = scene_of(hanging_rod()).run();
    set_joint(world, 0, {"shoulder", angle, 0});
    EXPECT_NEAR(angle_of(world.state().links[1]), angle, 1e-12);
    const auto energy = [&] {
      const world::LinkState& link = world.state().links[1];
      const double speed = link.angular_velocity.y(),
                   height = -length / 2 * std::cos(angle_of(link));
      return inertia * speed * speed / 2 + mass * testing::g * height;
    };
    const double start = energy();
    EXPECT_NEAR(start, -mass * testing::g * length / 2 * std::cos(angle), 1e-12);
    double before = angle, first = 0, last = 0;  // of passages of the lowest point [s]
    int passages = 0;
    for (double t = world.physical_length(); passages < 81; t += world.physical_length()) {
      world.step();
      const double now = angle_of(world.state().links[1]);
      if (before * now < 0 && std::abs(now) < 1.5) {
        // Between two ticks by the speed there, which is that of the lowest point but for second
        // order.
        last = t - now / world.state().links[1].angular_velocity.y();
        if (passages++ == 0) first = last;
      }
      before = now;
    }
    EXPECT_NEAR((last - first) / 40, period(angle), 2e-4 * period(angle)) << angle;
    EXPECT_NEAR(energy(), start, 1e-4 * mass * testing::g * length) << angle;
  }
}

TEST(SetJoint, WhatHangsOnItFollowsAndTheRestStays) {
  for (const bool elbow_first : {true, false}) {
    Simulation world = scene_of(hanging_machine()).run();
    const world::State before = world.state();
    const JointMotion shoulder{"shoulder", 0.7, 2}, elbow{"elbow", -1.1, -3};
    set_joint(world, 0, elbow_first ? elbow : shoulder);
    set_joint(world, 0, elbow_first ? shoulder : elbow);
    set_joint(world, 0, {"slide", 0.6, 0.5});
    const auto& links = world.state().links;
    const auto rod_at = [](double angle) {
      return Vector3(-length * std::sin(angle), 0, -length * std::cos(angle));
    };
    const Vector3 base(1, 2, 3), upper = base + rod_at(0.7), lower = upper + rod_at(0.7 - 1.1);
    EXPECT_LT((links[1].pose.position - upper).norm(), 1e-12);
    EXPECT_LT((links[2].pose.position - lower).norm(), 1e-12);
    EXPECT_NEAR(angle_of(links[2]), -0.4, 1e-12);
    EXPECT_LT((links[1].angular_velocity - Vector3(0, 2, 0)).norm(), 1e-12);
    EXPECT_LT((links[2].angular_velocity - Vector3(0, -1, 0)).norm(), 1e-12);
    const Vector3 of_upper = Vector3(0, 2, 0).cross(upper - base);
    EXPECT_LT((links[1].velocity - of_upper).norm(), 1e-12);
    EXPECT_LT((links[2].velocity - of_upper - Vector3(0, -1, 0).cross(lower - upper)).norm(),
              1e-12);
    EXPECT_LT((links[3].pose.position - Vector3(1, 2 + 0.3 + 0.6, 3)).norm(), 1e-12);
    EXPECT_LT((links[3].velocity - Vector3(0, 0.5, 0)).norm(), 1e-12);
    EXPECT_EQ(world.state().origins[0].position, before.origins[0].position);
    for (const int same : {0, 4, 5})
      EXPECT_LT((links[same].pose.position - before.links[same].pose.position).norm(), 1e-12)
          << same;
  }
}

TEST(SetJoint, TheRootOfAFloatingEntityStaysWhereItIs) {
  Simulation world = scene_of(hanging_machine(R"(movable="true")")).run();
  testing::run(world, 3);
  const world::LinkState before = world.state().links[0];
  set_joint(world, 0, {"shoulder", 1.2, 4});
  const world::LinkState& after = world.state().links[0];
  EXPECT_LT((after.pose.position - before.pose.position).norm(), 1e-12);
  EXPECT_LT((after.velocity - before.velocity).norm(), 1e-12);
  EXPECT_LT((after.angular_velocity - before.angular_velocity).norm(), 1e-12);
  const world::LinkState& upper = world.state().links[1];
  EXPECT_NEAR((upper.angular_velocity - after.angular_velocity)
                  .dot(after.pose.orientation * Vector3::UnitY()),
              4, 1e-12);
}

/// A robot that stands on the floor, and its cart on a slide.
TEST(SetJoint, WhatSleepsWakes) {
  testing::SmallScene scene = scene_of(
      R"(<prototype id="p" movable="true"><body position="0,0,0"/><links ref="base"><link id="base" geometry="box" size="2,2,.1" )"
      R"(mass="50"/><link id="cart" geometry="box" size=".1,.1,.1" mass="0.1" linear_damping="0"/></links><joints>)"
      R"(<joint id="slide" type="prismatic" axis="0,1,0"><parent link="base" position="0,0,.1"/><child link="cart" position="0,0,0"/>)"
      R"(</joint></joints></prototype>)");
  scene.engine = testing::ground;
  Simulation world = scene.run();
  testing::run(world, 100);
  set_joint(world, 0, {"slide", 0.2, 0.5});
  testing::run(world, 2);
  EXPECT_NEAR(world.state().links[1].pose.position.y(), 0.2 + 0.5 * 0.2, 1e-3);
}

std::string text_of(const Simulation& world, const JointMotion& wanted) {
  const auto fault = fault_of(world, 0, wanted);
  return fault ? fault->text : "";
}

TEST(SetJoint, WhatCannotBeSaysWhatIsAllowed) {
  const Simulation world = scene_of(hanging_machine()).run();
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                   infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(text_of(world, {"slide", 0.7, 1e6}), "");
  EXPECT_EQ(text_of(world, {"shoulder", -1e6, -1e6}), "");
  EXPECT_EQ(text_of(world, {"wrist", 0, 0}),
            "'p' has no joint 'wrist'; write one of 'shoulder', 'elbow', 'slide'.");
  EXPECT_EQ(text_of(world, {"weld", 0, 0}),
            "Joint 'weld' of 'p' is not revolute or prismatic: it has no position to set.");
  EXPECT_EQ(text_of(world, {"socket", 0, 0}),
            "Joint 'socket' of 'p' is not revolute or prismatic: it has no position to set.");
  EXPECT_EQ(text_of(world, {"slide", 0.71, 0}),
            "The position of joint 'slide' of 'p' is 0.71; it must be from -0.2 to 0.7 m.");
  EXPECT_EQ(text_of(world, {"elbow", nan, 0}),
            "The position of joint 'elbow' of 'p' is nan; it must be from -1e+06 to 1e+06 rad.");
  EXPECT_EQ(text_of(world, {"elbow", 0, -infinite}),
            "The velocity of joint 'elbow' of 'p' is -inf; it must be from -1e6 to 1e6 rad/s.");
  EXPECT_EQ(fault_of(world, 0, {"elbow", nan, nan})->of, JointFault::Of::position);
  EXPECT_EQ(fault_of(world, 0, {"elbow", 0, nan})->of, JointFault::Of::velocity);
  EXPECT_EQ(fault_of(world, 0, {"nothing", nan, nan})->of, JointFault::Of::joint);
  const Simulation box =
      scene_of(R"(<box id="b" size="1,1,1" movable="false"><body position="0,0,0"/></box>)").run();
  EXPECT_EQ(text_of(box, {"x", 0, 0}),
            "'b' has no joint 'x'; it has none that is revolute or prismatic.");
}

TEST(SetJoint, ASnapshotHasIt) {
  const scene::Scene scene = scene_of(hanging_machine()).read();
  Simulation world(scene, {1}), other(scene, {1});
  testing::run(world, 2);
  set_joint(world, 0, {"elbow", 2, -1});
  const Snapshot snapshot = world.snapshot();
  testing::run(world, 20);
  other.restore(scene, snapshot);
  testing::run(other, 20);
  EXPECT_EQ(other.hash(), world.hash());
  world.restore(scene, snapshot);
  testing::run(world, 20);
  EXPECT_EQ(other.hash(), world.hash());
  EXPECT_EQ(other.first_difference(world.snapshot()), "");
}

}  // namespace
}  // namespace ziggurat::simulation
