// SPDX-License-Identifier: MIT
// Devices of the e-puck under its own names: infrared proximity and light, ground, LEDs, wheels,
// and range and bearing.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "small_scene.h"

namespace ziggurat::simulation::epucks {
namespace {

using std::numbers::pi;
using testing::SmallScene;

constexpr double radius = 0.035;     // [m]
constexpr double degree = pi / 180;  // [rad]
constexpr double bearings[] = {17, 50, 90, 150, -150, -90, -50, -17};
const std::string proximity = R"(<epuck_proximity implementation="default"/>)";

std::string robot(const std::string& kind = "e-puck") {
  return "<" + kind + R"( id="r"><body/><controller config="c"/></)" + kind + ">";
}

/// A thin post outside of sensor `i`, its side at a distance.
std::string post(std::size_t i, double distance) {
  const double at = radius + distance + 0.005;
  const double angle = bearings[i] * degree;
  return R"(<cylinder id="post" radius="0.005" height="0.1" movable="false"><body position=")" +
         std::to_string(at * std::cos(angle)) + "," + std::to_string(at * std::sin(angle)) +
         R"(,0"/></cylinder>)";
}

std::vector<double> readings(const SmallScene& scene) {
  Simulation simulation = scene.run();
  simulation.step();
  return simulation.observations().device_readings;
}

std::vector<std::string> faults(const SmallScene& scene) {
  std::vector<std::string> found;
  for (const auto& problem : scene::read_text(scene.str(), "small.argos").problems) {
    if (problem.severity == scene::Problem::Severity::fault) found.push_back(problem.text);
  }
  return found;
}

TEST(EPuckProximity, ReadsTheCurveOfItsSensors) {
  for (const double d : {0.01, 0.02, 0.03, 0.04}) {
    const auto read = readings({"", proximity, robot() + post(2, d)});
    ASSERT_EQ(read.size(), 8u);
    EXPECT_NEAR(read[2], 298.701 * d * d - 36.8961 * d + 1.08212, 1e-6) << d;
    for (const std::size_t other : {0, 1, 3, 4, 5, 6, 7}) EXPECT_EQ(read[other], 0) << other;
  }
  EXPECT_EQ(readings({"", proximity, robot() + post(2, 0.001)})[2], 1) << "clamped";
  EXPECT_EQ(readings({"", proximity, robot() + post(2, 0.0501)})[2], 0) << "out of range";
}

TEST(EPuckProximity, CountsFromTheLeftOfTheFront) {
  const Simulation simulation = SmallScene{"", proximity, robot()}.run();
  ASSERT_EQ(simulation.layout().described.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(simulation.layout().described[i].properties.at(0), bearings[i] * degree, 1e-12);
    const auto read = readings({"", proximity, robot() + post(i, 0.01)});
    EXPECT_GT(read[i], 0.7) << i;
    EXPECT_EQ(std::ranges::max_element(read) - read.begin(), static_cast<std::ptrdiff_t>(i));
  }
}

TEST(EPuckLight, ReadsByDistanceAndAngle) {
  const std::string lamp =
      R"(<light id="lamp" position="0,1,0" color="yellow" intensity="2" medium="leds"/>)";
  const auto read = readings(
      {"", R"(<epuck_light implementation="default" calibrated="true"/>)", robot() + lamp});
  ASSERT_EQ(read.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) {
    const double aside = std::abs(std::remainder(pi / 2 - bearings[i] * degree, 2 * pi));
    EXPECT_NEAR(read[i], std::exp(-1.0) * std::max(0.0, 1 - 2 * aside / pi), 1e-9) << i;
  }
}

TEST(EPuckGround, TellsItsThreePlaces) {
  const Simulation simulation =
      SmallScene{"", R"(<epuck_ground implementation="rot_z_only"/>)", robot()}.run();
  ASSERT_EQ(simulation.layout().described.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& offset = simulation.layout().described[i].properties;
    EXPECT_EQ(offset, std::vector<double>({0.03, -0.009 + 0.009 * static_cast<double>(i)}));
  }
}

TEST(EPuckWheels, DriveItAsItsGeneralWheelsDo) {
  Simulation own = SmallScene{R"(<epuck_wheels implementation="default"/>)", "", robot()}.run();
  Simulation general = SmallScene{testing::wheels, "", robot()}.run();
  for (Simulation* each : {&own, &general}) {
    each->commands().wheels.at(0) = {0.05, 0.1};
    testing::run(*each, 10);
  }
  EXPECT_EQ(own.hash(), general.hash());
  EXPECT_GT(own.state().origins[0].position.norm(), 0.05);
}

TEST(EPuckWheels, HaveANoiseThatIsAShareOfTheirSpeed) {
  Simulation noisy =
      SmallScene{R"(<epuck_wheels implementation="default" noise_std_dev="0.1"/>)", "", robot()}
          .run();
  noisy.step();
  EXPECT_EQ(noisy.state().origins[0].position.norm(), 0) << "a wheel that stands has no noise";
  noisy.commands().wheels.at(0) = {0.1, 0.1};
  testing::run(noisy, 10);
  EXPECT_NE(noisy.state().origins[0].position.x(), 0.1);
  EXPECT_NEAR(noisy.state().origins[0].position.x(), 0.1, 0.02);
}

TEST(EPuckDevices, ShareLedsAndRangeAndBearingWithTheGeneralOnes) {
  const SmallScene scene{R"(<epuck_leds implementation="default" medium="leds"/>)"
                         R"(<epuck_range_and_bearing implementation="default"/>)",
                         R"(<epuck_range_and_bearing implementation="medium" medium="rab"/>)",
                         robot()};
  const Simulation simulation = scene.run();
  EXPECT_EQ(simulation.layout().robots[0].leds.count, 10u) << "a ring of 8, body and front";
  EXPECT_EQ(simulation.layout().robots[0].range_and_bearing.count, 1u);
}

TEST(EPuckDevices, BelongToEPucks) {
  const auto found =
      faults({R"(<epuck_wheels implementation="default"/>)", proximity, robot("foot-bot")});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NE(found[0].find("is of kind foot-bot and has none"), std::string::npos) << found[0];
}

}  // namespace
}  // namespace ziggurat::simulation::epucks
