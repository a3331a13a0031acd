// SPDX-License-Identifier: MIT
// Kilobots: how fast they go and turn, which messages arrive, how often, and from how far.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "small_scene.h"

namespace ziggurat::simulation {
namespace {

using std::numbers::pi;
using testing::ground;
using testing::SmallScene;

const std::string motors = R"(<kilobot_differential_drive implementation="default"/>)";
const std::string sender = R"(<kilobot_communication implementation="default"/>)";
constexpr double straight = 65, turning = 70;  // calibration of usual motors

std::string kilobot(const std::string& id, const std::string& place = "0,0,0",
                    const std::string& attributes = "") {
  return "<kilobot id=\"" + id + "\" " + attributes + "><body position=\"" + place +
         R"("/><controller config="c"/></kilobot>)";
}

std::string hearing(const std::string& attributes = "") {
  return R"(<kilobot_communication implementation="default" )" + attributes + "/>";
}

/// Robots in a row along x. @param more  attributes of the sensor
Simulation row(std::initializer_list<double> places, const std::string& more = "") {
  std::string robots;
  for (const double x : places) {
    robots += kilobot("k" + std::to_string(robots.size()), std::to_string(x) + ",0,0");
  }
  return SmallScene{sender, hearing(more), robots, ground}.run();
}

/// Lets a robot send its number and 1 ... 8.
void send(Simulation& simulation, std::size_t robot) {
  const auto& device = simulation.layout().described.at(robot);
  auto& commands = simulation.commands().device_commands;
  commands.at(device.commands.begin) = 1;
  commands.at(device.commands.begin + 1) = static_cast<double>(robot);
  for (std::size_t i = 1; i < 9; ++i)
    commands.at(device.commands.begin + 1 + i) = static_cast<double>(i);
}

const std::vector<double>& heard(const Simulation& simulation, std::size_t robot) {
  return simulation.observations().device_rows.at(robot).values;
}

/// Messages that a robot hears within so many ticks of 0.1 s.
std::size_t count(Simulation& simulation, std::size_t robot, int ticks) {
  std::size_t sum = 0;
  for (int i = 0; i < ticks; ++i) {
    simulation.step();
    sum += heard(simulation, robot).size() / 10;
  }
  return sum;
}

TEST(Kilobot, GoesACentimetreASecond) {
  Simulation simulation = SmallScene{motors, "", kilobot("k"), ground}.run();
  simulation.commands().device_commands = {straight, straight};
  testing::run(simulation, 100);
  EXPECT_NEAR(simulation.state().origins[0].position.x(), 0.1, 1e-6);
  EXPECT_NEAR(simulation.state().origins[0].position.y(), 0, 1e-9);
}

TEST(Kilobot, TurnsByFortyFiveDegreesASecondAboutALeg) {
  for (const double side : {1.0, -1.0}) {
    Simulation simulation = SmallScene{motors, "", kilobot("k"), ground}.run();
    simulation.commands().device_commands = {side > 0 ? turning : 0, side > 0 ? 0 : turning};
    testing::run(simulation, 20);  // a quarter turn
    const math::Pose& pose = simulation.state().origins[0];
    EXPECT_NEAR(math::heading_of(pose), side * pi / 2, 1e-4);
    // The leg at half an axle beside it stays.
    EXPECT_NEAR(pose.position.x(), 0.0125, 1e-4);
    EXPECT_NEAR(pose.position.y(), side * 0.0125, 1e-4);
  }
}

TEST(Kilobot, ACalibrationMakesUpForItsMotors) {
  Simulation simulation =
      SmallScene{motors, "", kilobot("k", "0,0,0", R"(left_motor="1.3" right_motor="0.8")"), ground}
          .run();
  const auto& properties = simulation.layout().described.at(0).properties;
  ASSERT_EQ(properties.size(), 4u);
  EXPECT_NEAR(properties[2], straight / 1.3, 1e-12);
  simulation.commands().device_commands = {properties[2], properties[3]};
  testing::run(simulation, 100);
  EXPECT_NEAR(simulation.state().origins[0].position.x(), 0.1, 1e-6);
  EXPECT_NEAR(math::heading_of(simulation.state().origins[0]), 0, 1e-9);
  simulation.commands().device_commands = {straight, straight};
  testing::run(simulation, 10);
  EXPECT_GT(math::heading_of(simulation.state().origins[0]), 0.3) << "not calibrated";
}

TEST(Kilobot, AlsoDrivesByWheels) {
  Simulation simulation = SmallScene{motors + testing::wheels, "", kilobot("k"), ground}.run();
  simulation.commands().wheels.at(0) = {0.01, 0.01};
  testing::run(simulation, 100);
  EXPECT_NEAR(simulation.state().origins[0].position.x(), 0.1, 1e-6);
}

TEST(Kilobot, SendsNineBytesTwiceASecondWithTheDistance) {
  Simulation simulation = row({0, 0.06});
  EXPECT_EQ(count(simulation, 1, 20), 0u) << "nobody sends";
  send(simulation, 0);
  EXPECT_EQ(count(simulation, 1, 100), 20u);
  EXPECT_EQ(count(simulation, 0, 20), 0u) << "not its own";
  for (int i = 0; i < 5 && heard(simulation, 1).empty(); ++i) simulation.step();
  ASSERT_EQ(heard(simulation, 1).size(), 10u);
  EXPECT_NEAR(heard(simulation, 1)[0], 0.06, 1e-9);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(heard(simulation, 1)[1 + i], double(i));
  simulation.commands().device_commands.at(0) = 0;
  EXPECT_EQ(count(simulation, 1, 20), 0u) << "it stopped";
}

TEST(Kilobot, MessagesReachTenCentimetresThroughOthers) {
  Simulation simulation = row({0, 0.05, 0.0999, 0.1001});
  send(simulation, 0);
  testing::run(simulation, 1);
  EXPECT_EQ(count(simulation, 2, 50), 10u);
  EXPECT_EQ(count(simulation, 3, 50), 0u);
}

TEST(Kilobot, RobotsSendAtTimesOfTheirOwn) {
  Simulation simulation = row({0, 0.04, -0.04, 0.08, -0.08});
  for (std::size_t i = 1; i < 5; ++i) send(simulation, i);
  std::size_t most = 0, sum = 0;
  for (int i = 0; i < 50; ++i) {
    simulation.step();
    most = std::max(most, heard(simulation, 0).size() / 10);
    sum += heard(simulation, 0).size() / 10;
  }
  EXPECT_EQ(sum, 40u);
  EXPECT_LT(most, 4u) << "all at once";
}

TEST(Kilobot, LosesMessagesAndMeasuresWithNoise) {
  Simulation simulation = row({0, 0.06}, R"(message_drop_prob="0.25" noise_std_dev="0.002")");
  send(simulation, 0);
  double sum = 0, squares = 0, number = 0;
  for (int i = 0; i < 5000; ++i) {
    simulation.step();
    for (std::size_t row = 0; row < heard(simulation, 1).size(); row += 10) {
      const double off = heard(simulation, 1)[row] - 0.06;
      sum += off;
      squares += off * off;
      number += 1;
    }
  }
  EXPECT_NEAR(number / 1000, 0.75, 4 * std::sqrt(0.25 * 0.75 / 1000));
  EXPECT_NEAR(sum / number, 0, 4 * 0.002 / std::sqrt(number));
  EXPECT_NEAR(std::sqrt(squares / number), 0.002, 4 * 0.002 / std::sqrt(2 * number));
}

TEST(Kilobot, SeesAmbientLightFromAbove) {
  const std::string lamp =
      R"(<light id="l" position="0.3,0,0.434" color="white" intensity="0.25" medium="leds"/>)";
  Simulation simulation =
      SmallScene{R"(<kilobot_led implementation="default"/>)",
                 R"(<kilobot_light implementation="rot_z_only"/>)", kilobot("k") + lamp, ground}
          .run();
  ASSERT_EQ(simulation.layout().leds.size(), 2u);
  simulation.step();
  EXPECT_NEAR(simulation.observations().device_readings.at(0), 0.25, 1e-6);  // (0.25 / 0.5)^2
}

}  // namespace
}  // namespace ziggurat::simulation
