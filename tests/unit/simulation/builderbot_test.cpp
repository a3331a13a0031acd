// SPDX-License-Identifier: MIT
// Pi-pucks, builderbots and blocks: drive, rangefinders, lift, magnets, camera.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "small_scene.h"

namespace ziggurat::simulation::builders {
namespace {

using testing::ground;
using testing::SmallScene;

const std::string magnetic = std::string(ground) + "<magnetism/>";

std::string robot(const std::string& kind, const std::string& attributes = "") {
  return "<" + kind + R"( id="r" )" + attributes + R"(><body/><controller config="c"/></)" + kind +
         ">";
}

std::string device(const std::string& name) {
  return "<" + name + R"( implementation="default"/>)";
}

std::string wall(double x, const std::string& height = "1") {
  return R"(<box id="wall" size="0.1,2,)" + height + R"(" movable="false"><body position=")" +
         std::to_string(x + 0.05) + R"(,0,0"/></box>)";
}

/// Values of the kind's first device.
double* commands(Simulation& simulation, const std::string& kind) {
  for (const auto& device : simulation.layout().described) {
    if (device.kind->name == kind)
      return &simulation.commands().device_commands.at(device.commands.begin);
  }
  ADD_FAILURE() << kind;
  return nullptr;
}

/// Readings of the devices of a kind, the first of each.
std::vector<double> readings(const Simulation& simulation, const std::string& kind) {
  std::vector<double> found;
  for (const auto& device : simulation.layout().described) {
    if (device.kind->name != kind) continue;
    found.push_back(simulation.observations().device_readings.at(device.readings.begin));
  }
  return found;
}

void drive(Simulation& simulation, double left, double right) {
  double* const speeds = commands(simulation, "differential_drive");
  speeds[0] = left;
  speeds[1] = right;
}

TEST(PiPuck, DrivesAsItsWheelsSay) {
  Simulation simulation = SmallScene{device("pipuck_differential_drive"),
                                     device("pipuck_differential_drive"), robot("pipuck"), ground}
                              .run();
  drive(simulation, 0.02, 0.02);
  testing::run(simulation, 50);
  EXPECT_NEAR(simulation.state().origins[0].position.x(), 0.1, 1e-4);
  EXPECT_EQ(readings(simulation, "differential_drive"), std::vector<double>({0.02}));
  drive(simulation, -0.01, 0.01);
  testing::run(simulation, 50);
  EXPECT_NEAR(math::heading_of(simulation.state().origins[0]), 0.02 / 0.053 * 5, 1e-3);
}

TEST(PiPuck, ItsRangefindersMeasureTheDistance) {
  Simulation simulation =
      SmallScene{"", device("pipuck_rangefinders") + device("pipuck_ground") + device("pipuck_imu"),
                 robot("pipuck") + wall(0.1), ground}
          .run();
  simulation.step();
  const auto found = readings(simulation, "rangefinders");
  ASSERT_EQ(found.size(), 8u);
  const double bearing = 0.30;  // of the last one, on the left of the front
  EXPECT_NEAR(found[7], (0.1 - 0.035 * std::cos(bearing)) / std::cos(bearing), 1e-6);
  EXPECT_EQ(found[4], 0.1) << "its range: there is nothing behind";
  EXPECT_EQ(readings(simulation, "ground").size(), 3u);
  EXPECT_EQ(simulation.layout().imus.size(), 1u);
}

TEST(Builderbot, DrivesAndTurnsWithItsLift) {
  Simulation simulation =
      SmallScene{device("builderbot_differential_drive") + device("builderbot_lift_system"),
                 device("builderbot_lift_system"), robot("builderbot"), ground}
          .run();
  *commands(simulation, "lift_system") = 0.1;
  drive(simulation, 0.05, 0.05);
  testing::run(simulation, 40);
  EXPECT_NEAR(readings(simulation, "lift_system").at(0), 0.1, 1e-3);
  EXPECT_NEAR(simulation.state().links[1].pose.position.z(), 0.1555, 1e-3);
  EXPECT_NEAR(simulation.state().origins[0].position.x(), 0.2, 1e-3);
  drive(simulation, 0, 0);
  testing::run(simulation, 5);
  drive(simulation, -0.02, 0.02);
  testing::run(simulation, 20);
  EXPECT_NEAR(math::heading_of(simulation.state().origins[0]), 0.04 / 0.104 * 2, 0.01);
  EXPECT_NEAR(simulation.state().origins[0].position.z(), 0, 1e-3);
}

TEST(Builderbot, ItsRangefindersSeeAheadAndBelow) {
  Simulation simulation =
      SmallScene{device("builderbot_lift_system"), device("builderbot_rangefinders"),
                 robot("builderbot") + wall(0.16), ground}
          .run();
  simulation.step();
  const auto found = readings(simulation, "rangefinders");
  ASSERT_EQ(found.size(), 16u);
  EXPECT_NEAR(found[0], 0.16 - 0.065, 1e-6);
  EXPECT_EQ(found[6], 0.2) << "behind";
  EXPECT_NEAR(found[12], 0.0555, 1e-4) << "the floor below the end effector";
  EXPECT_NEAR(found[13], 0.16 - 0.1075 - 0.0275, 1e-6);
}

TEST(Builderbot, LiftsABlockByItsMagnets) {
  const std::string block = R"(<block id="b"><body position="0.1075,0,0"/></block>)";
  Simulation simulation =
      SmallScene{device("builderbot_lift_system") + device("builderbot_electromagnet_system"),
                 device("builderbot_camera_system") + device("builderbot_nfc"),
                 robot("builderbot") + block, magnetic}
          .run();
  ASSERT_EQ(simulation.commands().magnet_currents.size(), 12u) << "4, and 8 of the block";
  testing::run(simulation, 10);
  EXPECT_EQ(simulation.observations().tags.size(), 1u) << "that of the face ahead";
  for (std::size_t i = 0; i < 4; ++i) simulation.commands().magnet_currents[i] = 1;
  *commands(simulation, "lift_system") = 0.08;
  testing::run(simulation, 40);
  EXPECT_NEAR(simulation.state().origins[1].position.z(), 0.08, 2e-3);
  for (std::size_t i = 0; i < 4; ++i) simulation.commands().magnet_currents[i] = -1;
  testing::run(simulation, 20);
  EXPECT_LT(simulation.state().origins[1].position.z(), 0.01) << "it falls";
}

}  // namespace
}  // namespace ziggurat::simulation::builders
