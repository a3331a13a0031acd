// SPDX-License-Identifier: MIT
// A listing of the technical report, as printed there: with stray spaces inside values and line
// breaks inside attributes.

#include <gtest/gtest.h>

#include <numbers>

#include "scene_text.h"

namespace ziggurat::scene {
namespace {

constexpr const char* foot_bot_controller = R"(<controllers><lua_controller id="fb">
<actuators >
<footbot_turret implementation="default"/>
<differential_steering implementation="default" />
</actuators>
<sensors >
<cameras implementation="default" show_frustum="true">
<camera id="fixed_camera" range="0.025:0.25" resolution="640,360"
anchor="origin" position=" -0.05,0,0.125" orientation="

90,-90,0"
focal_length="884,884" principle_point="320,180">
<led_detector medium="leds" show_rays="true"/>
<directional_led_detector medium="directional_leds" show_rays="

true"/>
<tag_detector medium="tags" show_rays="true"/>
</camera>
<camera id="turret_camera" range="0.025:0.225" resolution="640,360"
anchor="turret" position="0.08,0,0.1" orientation="

-90,112.5,0"
focal_length="884,884" principle_point="320,180">
<led_detector medium="leds" show_rays="true"/>
<directional_led_detector medium="directional_leds" show_rays="

true"/>
<tag_detector medium="tags" show_rays="true"/>
</camera>
</cameras>
<differential_steering implementation="default" />
</sensors>
<params script="src/testing/examples/footbot_camera_prototype_example.

lua"/>
</lua_controller></controllers>)";

constexpr const char* target = R"(<prototype id="target" movable="true">
<body position="0.25,0,0" orientation="0,0,0"/>
<links ref="base">
<link id="base" geometry="box" size="0.125,0.125,0.15"
mass="0.05" position="0,0,0" orientation="0,0,0" />
</links>
<devices >
<directional_leds medium="directional_leds">
<directional_led color="red" observable_angle="180" anchor="base"

position=" -0.063,0,0.05" orientation="0,-90,0"/>
</directional_leds>
<leds medium="leds">
<led color="blue" anchor="base" offset=" -0.063,0,0.06"/>
</leds>
<tags medium="tags">
<tag side_length=".025" observable_angle="180" anchor="base"
payload="0" position=" -0.063,0,0.125" orientation="0,-90,0" />
</tags>
</devices>
</prototype>)";

constexpr const char* all_media =
    R"(<media><led id="leds"/><directional_led id="directional_leds"/><tag id="tags"/>)"
    R"(<radio id="radio"/></media>)";

TEST(Listings, FootBotControllerAndTarget) {
  SceneText text;
  text.arena = arena_with(
      std::string(target) +
      R"(<foot-bot id="fb"><body position="0,0,0" orientation="0,0,0"/><controller config="fb"/></foot-bot>)");
  text.controllers = foot_bot_controller;
  text.media = all_media;
  const ReadResult result = text.read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  const auto& cameras = result.scene.controllers.at(0).devices.cameras->cameras;
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_EQ(cameras[1].anchor, "turret");
  EXPECT_EQ(cameras[0].near, 0.025);
  EXPECT_EQ(cameras[0].far, 0.25);
  EXPECT_EQ(cameras[0].principal_point, math::Vector2(320, 180));
  ASSERT_EQ(cameras[0].detectors.size(), 3u);
  EXPECT_TRUE(cameras[0].detectors[1].show_rays);
  EXPECT_EQ(cameras[0].detectors[2].kind, Detector::Kind::tag);
  const math::Vector3 forward = cameras[0].pose.orientation * math::Vector3::UnitZ();
  EXPECT_NEAR((forward + math::Vector3::UnitX()).norm(), 0, 1e-12);  // looks back
  const Entity& foot_bot = result.scene.entities.at(1);
  EXPECT_EQ(foot_bot.links.at(*foot_bot.turret).id, cameras[1].anchor);
  const ControllerDevices& enabled = result.scene.controllers[0].devices;
  ASSERT_TRUE(enabled.turret && enabled.wheels);
  EXPECT_TRUE(enabled.turret->actuator && enabled.wheels->actuator && enabled.wheels->sensor);
  const Devices& devices = result.scene.entities.at(0).devices;
  EXPECT_EQ(devices.directional_leds.at(0).id, "directional_led_0");
  EXPECT_EQ(devices.directional_leds.at(0).color, (Color{255, 0, 0}));
  EXPECT_DOUBLE_EQ(devices.directional_leds.at(0).observable_angle, std::numbers::pi);
  EXPECT_EQ(devices.tags.at(0).payload, "0");
  EXPECT_EQ(devices.tags.at(0).side_length, 0.025);
}

TEST(Listings, CarriageReturnsInsideValuesAreWhiteSpace) {
  SceneText text;
  text.arena = arena_with(target);
  text.controllers = foot_bot_controller;
  text.media = all_media;
  std::string windows;
  for (const char c : text.str()) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  const ReadResult result = read_text(windows, "windows.argos");
  EXPECT_TRUE(result.ok()) << all_problems(result);
}

}  // namespace
}  // namespace ziggurat::scene
