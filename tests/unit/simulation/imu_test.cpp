// SPDX-License-Identifier: MIT
// Readings of an inertial measurement unit, against closed forms.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "small_scene.h"

namespace ziggurat::simulation {
namespace {

using namespace testing;

std::string imu(const std::string& more = "", const std::string& anchor = "base") {
  return R"(<imus implementation="default"><imu id="imu" anchor=")" + anchor + "\" " + more +
         "/></imus>";
}

void expect_near(const std::array<double, 3>& read, const math::Vector3& expected, double bound) {
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(read[static_cast<std::size_t>(i)], expected[i], bound) << "axis " << i;
}

const world::ImuReading& imu_reading(const Simulation& simulation) {
  return simulation.observations().imus.at(0);
}

/// Push of the ground on a robot at rest, in the frame of its first link [m/s^2]: contacts leave it
/// tilted by some 1e-4 rad.
math::Vector3 push_of_ground(const Simulation& simulation) {
  return simulation.state().links[0].pose.orientation.conjugate() * math::Vector3(0, 0, g);
}

TEST(Imu, AtRestFeelsTheFloorPushUp) {
  Simulation world = SmallScene{"", imu(), robot("r", "0,0,0", ""), ground}.run();
  expect_near(imu_reading(world).acceleration, {0, 0, g}, 1e-12);  // tick 0
  run(world, 20);                                                  // asleep
  expect_near(imu_reading(world).acceleration, push_of_ground(world), 1e-9);
  EXPECT_NEAR(imu_reading(world).acceleration[2], g, 1e-5);
  expect_near(imu_reading(world).angular_velocity, {0, 0, 0}, 1e-9);
}

TEST(Imu, ReadsInItsOwnFrame) {
  // Turned by 90 degrees about y: x points down, z along the link's x.
  Simulation world =
      SmallScene{"", imu(R"(orientation="0,90,0")"), robot("r", "0,0,0", ""), ground}.run();
  run(world, 20);
  const math::Vector3 push = push_of_ground(world);
  expect_near(imu_reading(world).acceleration, {-push.z(), push.y(), push.x()}, 1e-9);
  EXPECT_NEAR(imu_reading(world).acceleration[0], -g, 1e-5);
}

TEST(Imu, WithoutGravityFeelsNothingAtRest) {
  Simulation world = SmallScene{"", imu(), robot("r", "0,0,1", "")}.run();
  run(world, 2);
  expect_near(imu_reading(world).acceleration, {0, 0, 0}, 1e-12);
}

TEST(Imu, InFreeFallFeelsNothing) {
  Simulation world =
      SmallScene{"", imu(), smooth_robot(R"(position="0,0,5" orientation="30,40,50")"),
                 R"(<gravity g="9.8"/>)"}
          .run();
  for (int i = 0; i < 4; ++i) {
    world.step();
    expect_near(imu_reading(world).acceleration, {0, 0, 0}, 1e-9);
  }
  EXPECT_LT(world.state().links[0].velocity.z(), -3) << "it falls";
}

TEST(Imu, InFreeFallThroughAirFeelsItsDrag) {
  // Damping of k = 0.04: a force of -m v (k + k |v|), v at the substep's beginning.
  std::string damped = smooth_robot(R"(position="0,0,5")");
  const std::string none = R"(linear_damping="0")";
  damped.replace(damped.find(none), none.size(), R"(linear_damping="0.04")");
  Simulation world = SmallScene{"", imu(), damped, R"(<gravity g="9.8"/>)"}.run();
  const auto drag = [](double v) { return 0.04 * v * (1 + v); };
  double v = 0;
  for (int i = 0; i < 4; ++i) {
    world.step();
    const double first = drag(v);
    v += (g - first) * 0.05;
    const double second = drag(v);
    v += (g - second) * 0.05;
    expect_near(imu_reading(world).acceleration, {0, 0, (first + second) / 2}, 1e-9);
  }
}

/// A link that turns about z with an IMU 0.3 m from the axis, x outwards.
SmallScene carousel() {
  return {
      R"(<joints implementation="default"><joint id="hinge" mode="velocity" max_impulse="9"/></joints>)",
      imu(R"(position="0.3,0,0")", "arm"),
      R"(<prototype id="r" movable="false"><body position="0,0,0"/><links ref="base">
             <link id="base" geometry="box" size=".1,.1,.1" mass="1"/>
             <link id="arm" geometry="cylinder" radius=".05" height=".05" mass="0.1"/></links>
             <joints><joint id="hinge" type="revolute" axis="0,0,1">
             <parent link="base" position="0,0,0.2" orientation="0,0,0"/>
             <child link="arm" position="0,0,0" orientation="0,0,0"/></joint></joints>
             <controller config="c"/></prototype>)",
      ground};
}

TEST(Imu, OnATurningLinkIsPulledInwards) {
  Simulation world = carousel().run();
  constexpr double rate = 2, radius = 0.3;  // [rad/s], [m]
  world.commands().joint_targets.at(0) = rate;
  run(world, 20);
  // The difference of two velocities half a substep h of turning apart: sin(wh/2) / (wh/2) of it.
  constexpr double half = rate * 0.05 / 2;
  const double inwards = rate * rate * radius * std::sin(half) / half;
  expect_near(imu_reading(world).acceleration, {-inwards, 0, g}, 1e-3);
  expect_near(imu_reading(world).angular_velocity, {0, 0, rate}, 1e-3);
}

TEST(Imu, ThatSpeedsUpIsPushedAlong) {
  Simulation world = carousel().run();
  world.commands().joint_targets.at(0) = 1;
  run(world, 1);
  // From 0 to 1 rad/s within the tick of 0.1 s, wherever in it: the mean of r dw/dt.
  EXPECT_NEAR(imu_reading(world).acceleration[1], 0.3 * 1 / 0.1, 0.02);
}

TEST(Imu, MeasuresAFastWheel) {  // more than half a turn in a tick
  Simulation world = carousel().run();
  constexpr double rate = 40;
  world.commands().joint_targets.at(0) = rate;
  run(world, 20);
  constexpr double half = rate * 0.05 / 2;
  EXPECT_NEAR(imu_reading(world).angular_velocity[2], rate, 0.01);
  EXPECT_NEAR(imu_reading(world).acceleration[0], -rate * rate * 0.3 * std::sin(half) / half,
              rate * rate * 0.3 * 0.01);
}

/// A slope of 20 degrees that rises towards +x, and a robot that stands on it, as steep.
SmallScene slope(const std::string& friction) {
  constexpr double angle = std::numbers::pi / 9;
  // The top of the slope is 0.2 m above its origin along its normal.
  const std::string at =
      std::to_string(-0.2 * std::sin(angle)) + ",0," + std::to_string(1 + 0.2 * std::cos(angle));
  return {"", imu(),
          R"(<box id="slope" size="4,4,0.2" movable="false" friction=")" + friction +
              R"("><body position="0,0,1" orientation="0,-20,0"/></box>)" +
              smooth_robot("position=\"" + at + R"(" orientation="0,-20,0")", friction),
          R"(<gravity g="9.8"/>)"};
}

TEST(Imu, AtRestOnASlopeReadsItsAngle) {
  Simulation world = slope("1").run();
  run(world, 20);
  const double angle = std::numbers::pi / 9;
  // Up in the world, seen from a frame whose x points up the slope.
  expect_near(imu_reading(world).acceleration, {g * std::sin(angle), 0, g * std::cos(angle)}, 0.02);
}

TEST(Imu, SlidingWithoutFrictionFeelsOnlyTheSlope) {
  Simulation world = slope("0").run();
  run(world, 8);
  expect_near(imu_reading(world).acceleration, {0, 0, g * std::cos(std::numbers::pi / 9)}, 0.02);
  EXPECT_LT(world.state().links[1].velocity.x(), -1) << "it slides";
}

TEST(Imu, FeelsNothingOfBeingMovedByASupervisor) {
  Simulation world =
      SmallScene{"", imu(), smooth_robot(R"(position="0,0,5")"), R"(<gravity g="9.8"/>)"}.run();
  run(world, 3);
  world.move(0, {{1, 1, 6}, math::Quaternion::Identity()});
  run(world, 1);
  expect_near(imu_reading(world).acceleration, {0, 0, 0}, 1e-9);
}

std::vector<double> first_axis(Simulation& world, int ticks) {
  std::vector<double> values;
  for (int i = 0; i < ticks; ++i) {
    world.step();
    values.push_back(imu_reading(world).acceleration[0]);
  }
  return values;
}

double deviation(const std::vector<double>& values) {
  double sum = 0, squares = 0;
  for (const double value : values) sum += value, squares += value * value;
  const double n = static_cast<double>(values.size());
  return std::sqrt(squares / n - sum / n * sum / n);
}

TEST(Imu, NoiseHasTheDeviationOfTheSceneAndRepeatsWithTheSeed) {
  const SmallScene scene{"", imu(R"(acceleration_noise="0.2")"), robot("r", "0,0,1", "")};
  Simulation world = scene.run(), same = scene.run(), other = scene.run(2);
  const std::vector<double> values = first_axis(world, 2000);
  EXPECT_NEAR(deviation(values), 0.2, 0.2 * 4 / std::sqrt(2 * 2000.0));  // four deviations
  EXPECT_EQ(first_axis(same, 2000), values);
  EXPECT_NE(first_axis(other, 2000), values);
  EXPECT_EQ(imu_reading(world).angular_velocity, (std::array<double, 3>{}));
}

TEST(Imu, BiasWalksWithTheRootOfTime) {
  // Over 200 s in steps of 0.1 s: each step has a deviation of 0.05 sqrt(0.1).
  Simulation world =
      SmallScene{"", imu(R"(angular_velocity_bias_walk="0.05")"), robot("r", "0,0,1", "")}.run();
  std::vector<double> steps;
  double last = 0;
  for (int i = 0; i < 2000; ++i) {
    world.step();
    const double now = imu_reading(world).angular_velocity[2];
    steps.push_back(now - last);
    last = now;
  }
  const double expected = 0.05 * std::sqrt(0.1);
  EXPECT_NEAR(deviation(steps), expected, expected * 4 / std::sqrt(2 * 2000.0));
  EXPECT_NE(last, 0);
}

TEST(Imu, OfOneRobotDrawsNothingFromAnother) {
  const std::string noisy = imu(R"(acceleration_noise="0.2")");
  Simulation alone = SmallScene{"", noisy, robot("r", "0,0,1", "")}.run();
  Simulation both = SmallScene{"", noisy, robot("r", "0,0,1", "") + robot("s", "2,0,1", "")}.run();
  EXPECT_EQ(first_axis(alone, 5), first_axis(both, 5));
}

}  // namespace
}  // namespace ziggurat::simulation
