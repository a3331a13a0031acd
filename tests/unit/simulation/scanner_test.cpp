// SPDX-License-Identifier: MIT
// The distance scanner: where its rays point and what they measure.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "small_scene.h"

namespace ziggurat::simulation::scanners {
namespace {

using std::numbers::pi;
using testing::SmallScene;

const std::string actuator = R"(<footbot_distance_scanner implementation="default"/>)";
const std::string sensor = R"(<footbot_distance_scanner implementation="rot_z_only"/>)";
constexpr double radius = 0.085036758;  // of the robot [m]

struct Row {
  double angle, distance;
  bool is_long;
};

std::vector<Row> rows(const Simulation& simulation) {
  const auto& read = simulation.observations().device_rows.at(0);
  std::vector<Row> found;
  for (std::size_t i = 0; i < read.values.size(); i += 3) {
    found.push_back({read.values[i], read.values[i + 1], read.values[i + 2] != 0});
  }
  return found;
}

std::string robot(const std::string& pose = "") {
  return R"(<foot-bot id="fb"><body )" + pose + R"(/><controller config="c"/></foot-bot>)";
}

/// A post of 2 cm whose side towards the origin is at (x, 0).
std::string post(double x) {
  return R"(<box id="post" size="0.02,0.02,1" movable="false"><body position=")" +
         std::to_string(x + 0.01) + R"(,0,0"/></box>)";
}

void command(Simulation& simulation, double mode, double angle, double speed) {
  simulation.commands().device_commands = {mode, angle, speed};
}

TEST(DistanceScanner, IsOffAtTheStart) {
  Simulation simulation = SmallScene{actuator, sensor, robot() + post(0.2)}.run();
  EXPECT_EQ(simulation.commands().device_commands, std::vector<double>({0, 0, 0}));
  testing::run(simulation, 2);
  EXPECT_TRUE(rows(simulation).empty());
}

TEST(DistanceScanner, MeasuresFromTheRobotsSide) {
  Simulation simulation = SmallScene{actuator, sensor, robot() + post(0.25)}.run();
  command(simulation, 1, 0, 0);
  simulation.step();
  const auto found = rows(simulation);
  ASSERT_EQ(found.size(), 4u);
  EXPECT_FALSE(found[0].is_long || found[1].is_long);
  EXPECT_NEAR(found[0].angle, 0, 1e-12);
  EXPECT_NEAR(found[0].distance, 0.25 - radius, 1e-9);
  EXPECT_NEAR(std::abs(found[1].angle), pi, 1e-12);
  EXPECT_EQ(found[1].distance, -0.02) << "nothing";
  EXPECT_NEAR(found[2].angle, -pi / 2, 1e-12);
  EXPECT_NEAR(found[3].angle, pi / 2, 1e-12);
}

TEST(DistanceScanner, LongRaysAreBlindWithinTwelveCentimetres) {
  for (const auto& [place, expected] :
       {std::pair(radius + 0.119, -0.01), std::pair(radius + 0.121, 0.121),
        std::pair(radius + 1.419, 1.419), std::pair(radius + 1.421, -0.02)}) {
    Simulation simulation = SmallScene{actuator, sensor, robot() + post(place)}.run();
    command(simulation, 1, pi / 2, 0);  // a long ray looks ahead
    simulation.step();
    for (const Row& row : rows(simulation)) {
      if (row.is_long && std::abs(row.angle) < 1e-9)
        EXPECT_NEAR(row.distance, expected, 1e-5) << place;
    }
  }
}

TEST(DistanceScanner, SpreadsItsRaysOverTheTurnOfATick) {
  Simulation simulation = SmallScene{actuator, sensor, robot()}.run();
  const double speed = 3;  // [rad/s]; 0.3 rad in a tick
  command(simulation, 2, 0, speed);
  testing::run(simulation, 2);
  const auto found = rows(simulation);
  ASSERT_EQ(found.size(), 24u);
  std::vector<double> ahead;
  for (const Row& row : found) {
    if (!row.is_long && std::abs(row.angle) < 1) ahead.push_back(row.angle);
  }
  ASSERT_EQ(ahead.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(ahead[i], 0.3 + 0.05 * static_cast<double>(i), 1e-9) << "from the last head angle";
  }
  command(simulation, 2, 0, -speed);
  simulation.step();
  for (const Row& row : rows(simulation)) {
    if (!row.is_long && std::abs(row.angle) < 1) {
      EXPECT_GT(row.angle, 0.3) << "backward over the same turn";
      EXPECT_LT(row.angle, 0.6 + 1e-9);
    }
  }
}

TEST(DistanceScanner, StandsStillAtSpeedZero) {
  Simulation simulation = SmallScene{actuator, sensor, robot()}.run();
  command(simulation, 2, 0, 0);
  simulation.step();
  EXPECT_EQ(rows(simulation).size(), 4u);
}

TEST(DistanceScanner, SeesNothingLowerThanItself) {
  const std::string low =
      R"(<box id="low" size="0.1,0.1,0.12" movable="false"><body position="0.25,0,0"/></box>)";
  Simulation simulation = SmallScene{actuator, sensor, robot() + low}.run();
  command(simulation, 1, 0, 0);
  simulation.step();
  EXPECT_EQ(rows(simulation)[0].distance, -0.02);
}

}  // namespace
}  // namespace ziggurat::simulation::scanners
