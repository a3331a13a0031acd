// SPDX-License-Identifier: MIT
// The Khepera IV: how it drives, and what its sensors read of a wall, the floor and a light.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "small_scene.h"

namespace ziggurat::simulation::khepera {
namespace {

using testing::ground;
using testing::SmallScene;

std::string device(const std::string& name) {
  return "<" + name + R"( implementation="default"/>)";
}
const std::string robot = R"(<kheperaiv id="k"><body/><controller config="c"/></kheperaiv>)";

std::string wall(double x) {
  return R"(<box id="w" size="0.1,2,1" movable="false"><body position=")" +
         std::to_string(x + 0.05) + R"(,0,0"/></box>)";
}

TEST(Khepera, DrivesAsItsWheelsSay) {
  Simulation simulation =
      SmallScene{device("differential_steering"), device("differential_steering"), robot, ground}
          .run();
  simulation.commands().wheels[0] = {0.1, -0.1};
  for (int i = 0; i < 10; ++i) simulation.step();
  const double turn = 0.2 / 0.1054 * 10 * 0.1;
  EXPECT_NEAR(
      simulation.state().origins[0].orientation.angularDistance(math::Quaternion::Identity()), turn,
      0.02 * turn);
}

TEST(Khepera, ItsUltrasoundReadsTheDistanceWithinItsReach) {
  const auto ahead = [](double away) {
    Simulation simulation =
        SmallScene{"", device("kheperaiv_ultrasound"), robot + wall(0.0704 + away), ground}.run();
    simulation.step();
    return simulation.observations().device_readings[2];
  };
  EXPECT_NEAR(ahead(0.7), 0.7, 1e-6);
  EXPECT_EQ(ahead(0.1), 0.2) << "nearer than the nearest";
  EXPECT_EQ(ahead(2.5), 2) << "beyond its range";
}

TEST(Khepera, ItsInfraredSeesAWallWithinAQuarterMetre) {
  const auto ahead = [](double away) {
    Simulation simulation =
        SmallScene{"", device("kheperaiv_proximity"), robot + wall(0.0704 + away), ground}.run();
    simulation.step();
    return simulation.observations().proximity[0];
  };
  EXPECT_NEAR(ahead(0.1), 0.0100527 / (0.1 + 0.000163144), 1e-4);
  EXPECT_EQ(ahead(0.3), 0);
}

TEST(Khepera, ItsGroundSensorsSeeAWhiteFloor) {
  Simulation simulation = SmallScene{"", device("kheperaiv_ground"), robot, ground}.run();
  simulation.step();
  EXPECT_EQ(simulation.observations().device_readings, (std::vector<double>{1, 1, 1, 1}));
}

}  // namespace
}  // namespace ziggurat::simulation::khepera
