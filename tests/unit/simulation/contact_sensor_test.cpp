// SPDX-License-Identifier: MIT
// Readings of a contact sensor, against closed forms.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "small_scene.h"

namespace ziggurat::simulation {
namespace {

using namespace testing;

constexpr const char* base =
    R"(<contact_sensors implementation="default"><contact_sensor id="skin" anchor="base"/>)"
    R"(</contact_sensors>)";

const world::ContactReading& contact(const Simulation& simulation, std::size_t sensor = 0) {
  return simulation.observations().contact_sensors.at(sensor);
}

/// The force on the first link, in the world: contacts leave a robot tilted by some 1e-4 rad.
math::Vector3 force(const Simulation& simulation) {
  const auto& [x, y, z] = contact(simulation).force;
  return simulation.state().links[0].pose.orientation * math::Vector3(x, y, z);
}

TEST(ContactSensor, AtRestFeelsItsWeight) {
  Simulation world = SmallScene{"", base, robot("r", "0,0,0", ""), ground}.run();
  EXPECT_EQ(contact(world).touches, 0) << "before the first tick";
  run(world, 10);  // robot() weighs 1 kg
  EXPECT_EQ(contact(world).touches, 1);
  EXPECT_NEAR(force(world).x(), 0, 1e-3);
  EXPECT_NEAR(force(world).y(), 0, 1e-3);
  EXPECT_NEAR(force(world).z(), g, 1e-3);
  EXPECT_NEAR(contact(world).strength, g, 1e-2);
}

TEST(ContactSensor, InTheAirFeelsNothing) {
  Simulation world = SmallScene{"", base, robot("r", "0,0,3", ""), ground}.run();
  run(world, 3);
  EXPECT_EQ(contact(world).touches, 0);
  EXPECT_EQ(contact(world).strength, 0);
}

TEST(ContactSensor, OnceInTheAirAgainFeelsNothing) {
  Simulation world = SmallScene{"", base, robot("r", "0,0,0", ""), ground}.run();
  run(world, 3);
  world.move(0, {{0, 0, 5}, math::Quaternion::Identity()});
  run(world, 2);
  EXPECT_EQ(contact(world).touches, 0);
  EXPECT_EQ(contact(world).strength, 0);
}

TEST(ContactSensor, WhileItLandsItsForceIsWhatChangesItsMomentum) {
  Simulation world = SmallScene{"", base, smooth_robot(R"(position="0,0,0.3")"), ground}.run();
  constexpr double tick = 0.1, mass = 1;
  double before = 0, impulse = 0;
  for (int i = 0; i < 6; ++i) {  // it sleeps later: that takes what is left of its velocity
    world.step();
    const double now = world.state().links[0].velocity.z();
    // m dv = (F - m g) dt, tick by tick
    EXPECT_NEAR(force(world).z() * tick, mass * (now - before + g * tick), 1e-6) << i;
    before = now;
    impulse += force(world).z() * tick;
  }
  EXPECT_GT(impulse, std::sqrt(2 * g * 0.25)) << "it landed";
}

TEST(ContactSensor, BetweenTwoOthersFeelsMoreStrengthThanForce) {
  // 1 kg on top of it: 9.8 N down from above, 19.6 N up from below.
  Simulation world = SmallScene{"", base,
                                robot("r", "0,0,0", "") +
                                    R"(<box id="load" size=".1,.1,.1" mass="1" movable="true">)"
                                    R"(<body position="0,0,0.1"/></box>)",
                                ground}
                         .run();
  run(world, 10);
  EXPECT_NEAR(contact(world).force[2], g, 0.05);
  EXPECT_NEAR(contact(world).strength, 3 * g, 0.15);
}

TEST(ContactSensor, ReadsInTheFrameOfItsLink) {
  // Lies on its side: its x axis points up.
  Simulation world = SmallScene{"", base, robot("r", "-0.05,0,0.05", "", "0,-90,0"), ground}.run();
  run(world, 10);
  EXPECT_NEAR(std::abs(contact(world).force[0]), g, 0.05);
  EXPECT_NEAR(contact(world).force[2], 0, 0.05);
}

TEST(ContactSensor, TwoOnOneLinkReadTheSame) {
  const std::string two =
      R"(<contact_sensors implementation="default"><contact_sensor id="a" anchor="base"/>)"
      R"(<contact_sensor id="b" anchor="origin"/></contact_sensors>)";
  Simulation world = SmallScene{"", two, robot("r", "0,0,0", ""), ground}.run();
  run(world, 3);
  EXPECT_EQ(contact(world, 1).touches, 1);
  EXPECT_EQ(contact(world, 1).force, contact(world, 0).force);
}

TEST(ContactSensor, OfALinkThatNothingTouches) {
  const std::string arms = R"(<prototype id="r"><body position="0,0,0"/><links ref="base">
      <link id="base" geometry="box" size=".1,.1,.1" mass="1"/>
      <link id="arm" geometry="box" size=".05,.05,.05" mass="0.1"/></links>
      <joints><joint id="hinge" type="revolute" axis="0,0,1">
      <parent link="base" position="0,0,0.15" orientation="0,0,0"/>
      <child link="arm" position="0,0,0" orientation="0,0,0"/></joint></joints>
      <controller config="c"/></prototype>)";
  const std::string sensors =
      R"(<contact_sensors implementation="default"><contact_sensor id="a" anchor="arm"/>)"
      R"(<contact_sensor id="b" anchor="base"/></contact_sensors>)";
  Simulation world = SmallScene{"", sensors, arms, ground}.run();
  run(world, 10);
  EXPECT_EQ(contact(world, 0).touches, 0);
  EXPECT_EQ(contact(world, 1).touches, 1);
  EXPECT_NEAR(contact(world, 1).force[2], 1.1 * g, 0.05);
}

TEST(ContactSensor, OfARobotThatComesAndGoes) {
  SmallScene small{"", base, robot("r", "0,0,0", ""), ground};
  const scene::Scene scene = small.read();
  Simulation world(scene, {1});
  run(world, 2);
  scene::Entity second = scene.entities[0];
  second.id = "s";
  second.pose.position = {1, 0, 0};
  world.spawn(scene, second);
  run(world, 5);
  EXPECT_EQ(contact(world, 1).touches, 1);
  world.remove(0);
  run(world, 2);
  EXPECT_NEAR(contact(world, 1).force[2], g, 0.05);
}

}  // namespace
}  // namespace ziggurat::simulation
