// SPDX-License-Identifier: MIT
// Coloured-blob cameras: bearing and distance of a blob, or its pixel; what hides it.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "small_scene.h"

namespace ziggurat::simulation::blob_cameras {
namespace {

using std::numbers::pi;
using testing::SmallScene;

const std::string around =
    R"(<colored_blob_omnidirectional_camera implementation="rot_z_only" medium="leds"/>)";
const std::string ahead =
    R"(<colored_blob_perspective_camera implementation="default" medium="leds"/>)";
constexpr double anchor_x = 0.085036758, anchor_z = 0.174249733;  // of the perspective camera [m]

std::string robot(const std::string& pose = "", const std::string& attributes = "") {
  return R"(<foot-bot id="fb" )" + attributes + "><body " + pose +
         R"(/><controller config="c"/></foot-bot>)";
}

std::string lamp(const std::string& position, const std::string& color = "red",
                 const std::string& id = "lamp") {
  return R"(<light id=")" + id + R"(" position=")" + position + R"(" color=")" + color +
         R"(" intensity="1" medium="leds"/>)";
}

using Blob = std::array<double, 3>;

std::vector<Blob> blobs(const Simulation& simulation) {
  const auto& values = simulation.observations().device_rows.at(0).values;
  std::vector<Blob> found;
  for (std::size_t i = 0; i < values.size(); i += 3)
    found.push_back({values[i], values[i + 1], values[i + 2]});
  return found;
}

/// After a tick with the camera on.
std::vector<Blob> seen(const SmallScene& scene) {
  Simulation simulation = scene.run();
  simulation.commands().device_commands = {1};
  simulation.step();
  return blobs(simulation);
}

TEST(OmnidirectionalCamera, ReadsDistanceAndBearingOverTheGround) {
  const std::string turned = robot(R"(position="1,0,0" orientation="90,0,0")");
  const auto found = seen({"", around, turned + lamp("1.3,0.4,0.1", "0,128,255,255")});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0][0], 0.5, 1e-6);
  EXPECT_NEAR(found[0][1], std::atan2(0.4, 0.3) - pi / 2, 1e-6);
  EXPECT_EQ(found[0][2], 0x0080FF);
}

TEST(OmnidirectionalCamera, IsBlindUntilItIsSwitchedOnAndKeepsWhatItSaw) {
  Simulation simulation = SmallScene{"", around, robot() + lamp("0.5,0,0")}.run();
  simulation.step();
  EXPECT_TRUE(blobs(simulation).empty());
  simulation.commands().device_commands = {1};
  simulation.step();
  EXPECT_EQ(blobs(simulation).size(), 1u);
  simulation.commands().device_commands = {0};
  simulation.remove(1);
  simulation.step();
  EXPECT_EQ(blobs(simulation).size(), 1u);
}

// A square of half side 0.288699733 tan(70°) = 0.7932 m at the height of the floor.
TEST(OmnidirectionalCamera, SeesASquareOfTheFloor) {
  EXPECT_EQ(seen({"", around, robot() + lamp("0.79,0.79,0")}).size(), 1u);
  EXPECT_EQ(seen({"", around, robot() + lamp("0.80,0,0")}).size(), 0u);
  EXPECT_EQ(seen({"", around, robot() + lamp("0.1,0,0.29")}).size(), 0u) << "above it";
}

TEST(OmnidirectionalCamera, SeesNoBlackNorHiddenNorOwnLights) {
  const std::string wall = R"(<box id="wall" size="0.02,1,1" movable="false">)"
                           R"(<body position="0.3,0,0"/></box>)";
  EXPECT_TRUE(seen({"", around, robot() + lamp("0.5,0,0", "black")}).empty());
  EXPECT_TRUE(seen({"", around, robot() + wall + lamp("0.5,0,0")}).empty());
  const std::string leds = R"(<leds implementation="default" medium="leds"/>)";
  Simulation own = SmallScene{leds, around, robot()}.run();
  own.commands().device_commands = {1};
  own.commands().led_colors.assign(13, 0xFF0000);
  testing::run(own, 2);
  EXPECT_TRUE(blobs(own).empty());
}

TEST(PerspectiveCamera, ReadsThePixelOfItsPinhole) {
  // 1 m ahead, 0.1 m to the left and 0.05 m above the axis.
  const std::string at = std::to_string(anchor_x + 1) + ",0.1," + std::to_string(anchor_z + 0.05);
  const auto found = seen({"", ahead, robot() + lamp(at)});
  ASSERT_EQ(found.size(), 1u);
  // The half diagonal of 400 pixels is tan(30°) of the axis.
  const double pixels = 400 / std::tan(pi / 6);
  EXPECT_EQ(found[0][0], std::trunc(320 - 0.1 * pixels));
  EXPECT_EQ(found[0][1], std::trunc(240 - 0.05 * pixels));
  EXPECT_EQ(found[0][2], 0xFF0000);
}

TEST(PerspectiveCamera, SeesWithinItsRangeAndAperture) {
  const auto count = [](const std::string& at) {
    return seen({"", ahead, robot() + lamp(at)}).size();
  };
  EXPECT_EQ(count("2.08,0,0.174"), 1u);
  EXPECT_EQ(count("2.09,0,0.174"), 0u);
  EXPECT_EQ(count("-0.5,0,0.174"), 0u);
  EXPECT_EQ(count("1.085,0.6,0.174"), 0u) << "31 degrees aside";
}

TEST(PerspectiveCamera, LooksUpwardWhateverTheHeading) {
  for (const std::string heading : {"0", "77"}) {
    const std::string up =
        robot("orientation=\"" + heading + ",0,0\"", R"(perspective_camera_front="false")");
    const double yaw = std::stod(heading) * pi / 180;
    const std::string above = std::to_string(anchor_x * std::cos(yaw)) + "," +
                              std::to_string(anchor_x * std::sin(yaw)) + ",1";
    const auto found = seen({"", ahead, up + lamp(above)});
    ASSERT_EQ(found.size(), 1u) << heading;
    EXPECT_NEAR(found[0][0], 320, 1);
    EXPECT_NEAR(found[0][1], 240, 1);
  }
}

}  // namespace
}  // namespace ziggurat::simulation::blob_cameras
