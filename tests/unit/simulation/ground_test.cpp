// SPDX-License-Identifier: MIT
// Ground sensors on a floor with a picture: which pixel lies below a point.

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <variant>
#include <vector>

#include "../temporary_folder.h"
#include "small_scene.h"

namespace ziggurat::simulation::ground_sensors {
namespace {

using testing::SmallScene;

const std::string grey = R"(<footbot_motor_ground implementation="rot_z_only"/>)";
const std::string binary = R"(<footbot_base_ground implementation="rot_z_only"/>)";
const std::string all = R"(<ground implementation="rot_z_only"/>)";

/// The arena of SmallScene is 9 m wide: of two pixels the left is x < 0.
std::string ppm(const std::string& size, const std::string& pixels) {
  return "P6 " + size + " 255\n" + pixels;
}
const std::string black(3, '\0'), white(3, '\xff'), red("\xff\0\0", 3);

class Ground : public ::testing::Test {
 protected:
  /// Readings of a foot-bot at a pose on a floor with that picture, after a tick.
  std::vector<double> on(const std::string& picture, const std::string& sensor,
                         const std::string& pose, const std::string& kind = "foot-bot") {
    std::ofstream(folder_ / "floor.ppm", std::ios::binary) << picture;
    const SmallScene scene{"", sensor,
                           R"(<floor id="f" source="image" path="floor.ppm"/><)" + kind +
                               R"( id="r"><body )" + pose + R"(/><controller config="c"/></)" +
                               kind + ">"};
    const auto read = scene::read_text(scene.str(), (folder_ / "s.argos").string());
    EXPECT_TRUE(read.ok());
    Simulation simulation(read.scene, {1});
    simulation.step();
    return simulation.observations().device_readings;
  }
  TemporaryFolder folder_;
};

TEST_F(Ground, AnEdgeLiesBetweenSensors) {
  const std::vector<double> readings = on(ppm("2 1", black + white), grey, R"(position="0,1,0")");
  ASSERT_EQ(readings.size(), 4u);
  EXPECT_EQ(readings[0], 1) << "front left";
  EXPECT_EQ(readings[1], 0) << "rear left";
  EXPECT_EQ(readings[2], 0);
  EXPECT_EQ(readings[3], 1);
}

TEST_F(Ground, SensorsTurnWithTheRobot) {
  const std::vector<double> readings =
      on(ppm("2 1", black + white), grey, R"(position="0,1,0" orientation="180,0,0")");
  EXPECT_EQ(readings[0], 0);
  EXPECT_EQ(readings[1], 1);
}

TEST_F(Ground, TheFirstRowOfThePictureIsFarthestUp) {
  const std::string picture = ppm("1 2", white + black);
  EXPECT_EQ(on(picture, grey, R"(position="0,1,0")")[0], 1);
  EXPECT_EQ(on(picture, grey, R"(position="0,-1,0")")[0], 0);
}

TEST_F(Ground, ColoursAreAsBrightAsTheEyeSeesThem) {
  EXPECT_NEAR(on(ppm("1 1", red), grey, "")[0], 0.299, 1e-12);
  EXPECT_EQ(on(ppm("1 1", red), binary, "")[0], 0) << "below a half";
}

TEST_F(Ground, AroundThePictureItIsWhite) {
  EXPECT_EQ(on(ppm("1 1", black), grey, R"(position="5,0,0")")[0], 1);
}

TEST_F(Ground, GenericSensorsAreFourGreyAndEightBinary) {
  const std::vector<double> readings = on(ppm("1 1", red), all, "");
  ASSERT_EQ(readings.size(), 12u);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_NEAR(readings[i], i < 4 ? 0.299 : 0, 1e-12) << i;
  EXPECT_EQ(on(ppm("1 1", red), all, "", "e-puck").size(), 3u);
}

TEST(GroundWithoutPicture, IsWhite) {
  const std::string robot = R"(<foot-bot id="r"><body/><controller config="c"/></foot-bot>)";
  Simulation simulation = SmallScene{"", all, robot}.run();
  simulation.step();
  for (const double reading : simulation.observations().device_readings) EXPECT_EQ(reading, 1);
}

TEST(PaintedGround, HasTheImageThatADirectorLays) {
  Simulation simulation =
      SmallScene{"", grey, R"(<foot-bot id="r"><body/><controller config="c"/></foot-bot>)"}.run();
  world::FloorPaint image{{0, 0}, {4.5, 4.5}};
  image.image = std::get<0>(world::floor_image(ppm("2 1", black + red)));
  simulation.commands().floor_paints = {image};
  simulation.step();
  EXPECT_NEAR(simulation.observations().device_readings[0], 0.299, 1e-12) << "front left";
  EXPECT_EQ(simulation.observations().device_readings[1], 0) << "rear left";
}

TEST(PaintedGround, CoversThePictureFromTheNextTickOn) {
  Simulation simulation =
      SmallScene{"", grey, R"(<foot-bot id="r"><body/><controller config="c"/></foot-bot>)"}.run();
  const auto readings = [&] { return simulation.observations().device_readings; };
  simulation.step();
  EXPECT_EQ(readings(), std::vector<double>({1, 1, 1, 1}));
  simulation.commands().floor_paints = {{{5, 0}, {5, 9}, false, 0xFF0000}};  // x > 0
  simulation.step();
  EXPECT_TRUE(simulation.commands().floor_paints.empty());
  EXPECT_NEAR(readings()[0], 0.299, 1e-12) << "front left";
  EXPECT_EQ(readings()[1], 1) << "rear left";
  simulation.step();
  EXPECT_NEAR(readings()[3], 0.299, 1e-12) << "it stays";
  // 0.0116 m from the robot's axis, 0.063 m ahead.
  simulation.commands().floor_paints = {{{0.063, 0.0116}, {0.001, 0.001}, true, 0}};
  simulation.step();
  EXPECT_EQ(readings()[0], 0);
  EXPECT_NEAR(readings()[3], 0.299, 1e-12);
}

TEST(PaintedGround, IsPartOfTheState) {
  const SmallScene scene{"", grey,
                         R"(<foot-bot id="r"><body/><controller config="c"/></foot-bot>)"};
  const scene::Scene read = scene.read();
  Simulation plain(read, {1}), painted(read, {1});
  painted.commands().floor_paints = {{{5, 5}, {1, 1}, true, 0x123456}};  // far from sensors
  plain.step();
  painted.step();
  EXPECT_NE(plain.hash(), painted.hash());
  Snapshot snapshot = painted.snapshot();
  snapshot.is_checked = false;  // as if it was read from a file
  plain.restore(read, snapshot);
  EXPECT_EQ(plain.hash(), painted.hash());
  ASSERT_EQ(plain.state().floor.size(), 1u);
  EXPECT_EQ(plain.state().floor[0].color, 0x123456U);
}

}  // namespace
}  // namespace ziggurat::simulation::ground_sensors
