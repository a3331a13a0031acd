// SPDX-License-Identifier: MIT
// Lights and light sensors: closed forms of a light at a distance and an angle, behind a wall, with
// noise; lights that move, come, go and are switched.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <span>
#include <string>

#include "small_scene.h"

namespace ziggurat::simulation::lights {
namespace {

using std::numbers::pi;
using testing::SmallScene;

const std::string ring = R"(<footbot_light implementation="rot_z_only"/>)";
const std::string photodiodes = R"(<light implementation="default"/>)";

std::string lamp(const std::string& position, const std::string& intensity = "1",
                 const std::string& color = "yellow", const std::string& id = "lamp") {
  return R"(<light id=")" + id + R"(" position=")" + position + R"(" color=")" + color +
         R"(" intensity=")" + intensity + R"(" medium="leds"/>)";
}

std::string robot(const std::string& kind = "foot-bot", const std::string& pose = "") {
  return "<" + kind + R"( id="fb"><body )" + pose + R"(/><controller config="c"/></)" + kind + ">";
}

std::string wall(const std::string& position) {
  return R"(<box id="wall" size="0.02,1,1" movable="false"><body position=")" + position +
         R"("/></box>)";
}

std::span<const double> readings(const Simulation& simulation) {
  return simulation.observations().device_readings;
}

/// Direction of sensor `i` of 24, from 0, about +z [rad].
double bearing(std::size_t i) { return (7.5 + 15 * static_cast<double>(i)) * pi / 180; }

double expected_in_ring(double distance, double direction, std::size_t sensor) {
  const double aside = std::abs(std::remainder(direction - bearing(sensor), 2 * pi));
  return distance > 2.5 ? 0 : std::exp(-2 * distance) * std::max(0.0, 1 - 2 * aside / pi);
}

TEST(LightRing, ReadsALightByDistanceAndAngle) {
  Simulation simulation = SmallScene{"", ring, robot() + lamp("0.3,0.4,1.2", "2")}.run();
  for (const double reading : readings(simulation)) EXPECT_EQ(reading, 0) << "at tick 0";
  simulation.step();
  ASSERT_EQ(readings(simulation).size(), 24u);
  for (std::size_t i = 0; i < 24; ++i) {
    EXPECT_NEAR(readings(simulation)[i], expected_in_ring(1.3 / 2, std::atan2(0.4, 0.3), i), 1e-12)
        << i;
  }
}

TEST(LightRing, TurnsWithItsRobot) {
  const std::string turned = robot("foot-bot", R"(position="1,1,0" orientation="90,0,0")");
  Simulation simulation = SmallScene{"", ring, turned + lamp("2,1,0")}.run();
  simulation.step();
  for (std::size_t i = 0; i < 24; ++i) {
    EXPECT_NEAR(readings(simulation)[i], expected_in_ring(1, -pi / 2, i), 1e-9) << i;
  }
}

TEST(LightRing, TellsTheAngleOfEachSensor) {
  const Simulation simulation = SmallScene{"", ring, robot()}.run();
  ASSERT_EQ(simulation.layout().described.size(), 24u);
  for (std::size_t i = 0; i < 24; ++i) {
    const double angle = simulation.layout().described[i].properties.at(0);
    EXPECT_NEAR(angle, std::remainder(bearing(i), 2 * pi), 1e-12);
  }
}

TEST(LightRing, SeesNothingBehindAWallNorBeyondItsRange) {
  Simulation hidden = SmallScene{"", ring, robot() + wall("0.5,0,0") + lamp("1,0,0.5")}.run();
  Simulation far = SmallScene{"", ring, robot() + lamp("2.51,0,0")}.run();
  Simulation near = SmallScene{"", ring, robot() + lamp("2.49,0,0")}.run();
  for (Simulation* each : {&hidden, &far, &near}) each->step();
  EXPECT_EQ(readings(hidden)[0], 0);
  EXPECT_EQ(readings(far)[0], 0);
  EXPECT_NEAR(readings(near)[0], expected_in_ring(2.49, 0, 0), 1e-12);
}

TEST(LightRing, AddsLightsUpToOne) {
  Simulation two =
      SmallScene{"", ring, robot() + lamp("1,0,0") + lamp("0,1,0", "1", "red", "other")}.run();
  Simulation many =
      SmallScene{"", ring, robot() + lamp("0.2,0,0", "9") + lamp("0.2,0.01,0", "9", "red", "other")}
          .run();
  two.step();
  many.step();
  EXPECT_NEAR(readings(two)[2], expected_in_ring(1, 0, 2) + expected_in_ring(1, pi / 2, 2), 1e-12);
  EXPECT_EQ(readings(many)[0], 1);
}

// The mean of a uniform variable in ± a is 0, its variance a^2 / 3.
TEST(LightRing, NoiseIsUniformAndRepeatsWithTheSeed) {
  const SmallScene scene{"", R"(<footbot_light implementation="rot_z_only" noise_level="0.1"/>)",
                         robot() + lamp("0.5,0,0")};
  Simulation one = scene.run(1), same = scene.run(1), other = scene.run(2);
  double sum = 0, squares = 0;
  constexpr int ticks = 1000;
  for (int i = 0; i < ticks; ++i) {
    for (Simulation* each : {&one, &same, &other}) each->step();
    const double error = readings(one)[0] - expected_in_ring(0.5, 0, 0);
    EXPECT_LE(std::abs(error), 0.1);
    sum += error;
    squares += error * error;
  }
  EXPECT_EQ(one.hash(), same.hash());
  EXPECT_NE(one.hash(), other.hash());
  EXPECT_NEAR(sum / ticks, 0, 4 * 0.1 / std::sqrt(3.0 * ticks));
  EXPECT_NEAR(squares / ticks, 0.01 / 3, 0.0005);
}

TEST(Photodiodes, ReadTheSquareOfIntensityOverDistance) {
  Simulation simulation = SmallScene{"", photodiodes, robot() + lamp("2,0,0.06", "0.5")}.run();
  simulation.step();
  constexpr double radius = 0.085036758;
  ASSERT_EQ(readings(simulation).size(), 24u);
  const double x = radius * std::cos(bearing(0)), y = radius * std::sin(bearing(0));
  EXPECT_NEAR(readings(simulation)[0], 0.25 / ((2 - x) * (2 - x) + y * y), 1e-12);
  for (std::size_t i = 7; i < 17; ++i) EXPECT_EQ(readings(simulation)[i], 0) << "in its own shadow";
}

TEST(Photodiodes, OfAnEPuckAreEight) {
  Simulation simulation = SmallScene{"", photodiodes, robot("e-puck") + lamp("1,0,0.03")}.run();
  simulation.step();
  ASSERT_EQ(readings(simulation).size(), 8u);
  EXPECT_NEAR(readings(simulation)[0], readings(simulation)[7], 1e-9) << "it is straight ahead";
  EXPECT_EQ(readings(simulation)[3], 0);
}

TEST(Light, HasNoBodyAndShowsItsColour) {
  Simulation simulation = SmallScene{"", ring, robot() + lamp("0,0,0.05", "1", "red")}.run();
  testing::run(simulation, 10);
  EXPECT_LT(simulation.state().origins[0].position.norm(), 1e-9) << "nothing pushes the robot away";
  EXPECT_EQ(simulation.state().origins[1].position, math::Vector3(0, 0, 0.05));
  ASSERT_EQ(simulation.layout().entities[1].leds.count, 1u);
  EXPECT_EQ(simulation.state().led_colors[simulation.layout().entities[1].leds.begin], 0xFF0000u);
}

TEST(Light, MovesIsSwitchedAndGoes) {
  Simulation simulation = SmallScene{"", ring, robot() + lamp("1,0,0")}.run();
  simulation.move(1, {{0, 1, 0}, math::Quaternion::Identity()});
  simulation.step();
  EXPECT_NEAR(readings(simulation)[6], expected_in_ring(1, pi / 2, 6), 1e-12);
  const std::size_t led = simulation.layout().entities[1].leds.begin;
  simulation.commands().led_colors[led] = 0;
  simulation.step();
  EXPECT_EQ(readings(simulation)[6], 0) << "switched off";
  simulation.commands().led_colors[led] = 0xFFFFFF;
  simulation.step();
  EXPECT_GT(readings(simulation)[6], 0);
  simulation.remove(1);
  simulation.step();
  EXPECT_EQ(readings(simulation)[6], 0) << "removed";
}

TEST(Light, ThatTheSceneHasBlackShinesAllTheSame) {
  Simulation simulation = SmallScene{"", ring, robot() + lamp("1,0,0", "1", "black")}.run();
  simulation.step();
  EXPECT_NEAR(readings(simulation)[0], expected_in_ring(1, 0, 0), 1e-12);
}

}  // namespace
}  // namespace ziggurat::simulation::lights
