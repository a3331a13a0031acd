// The listings of the technical report, as printed there: with stray spaces inside values, line
// breaks inside attributes and an `f` behind a number.

#include <gtest/gtest.h>

#include <numbers>

#include "scene_text.h"

namespace ziggurat::scene {
namespace {

constexpr const char* single_bodies_engine = R"(<physics_engines >
<dynamics3d id="dyn3d" iterations="20">
<floor height="0.01"/>
<gravity g="9.8" />
</dynamics3d>
</physics_engines>)";

constexpr const char* magnetism_engine = R"(<physics_engines >
<dynamics3d id="dyn3d" iterations="20">
<floor height="0.01"/>
<gravity g="9.8" />
<magnetism max_distance="0.1" />
</dynamics3d>
</physics_engines>)";

constexpr const char* vehicle = R"(<prototype id="vehicle" movable="true">
<body position="0,0,0" orientation="0,0,0" />
<controller config="my_controller"/>
<links ref="base">
<link id="base" geometry="box" size="0.1,0.05,0.02"
mass="1" position="0,0,0.01" orientation="0,0,0" />
<link id="wheel_fl" geometry="cylinder" radius="0.02" height=".005"
mass=".05" position=".025,.025,0.02" orientation="0,0,-90" />
<link id="wheel_fr" geometry="cylinder" radius="0.02" height=".005"

mass=".05" position=".025,-.025,0.02" orientation="0,0,90" />
<link id="wheel_br" geometry="cylinder" radius="0.02" height=".005"
mass=".05" position=" -.025,-.025,0.02" orientation="0,0,90" />
<link id="wheel_bl" geometry="cylinder" radius="0.02" height=".005"
mass=".05" position=" -.025,.025,0.02" orientation="0,0,-90" />
</links>
<joints >
<joint id="base_wheel_fr" type="revolute" axis="0,0,1">
<parent link="base" position=".025,-.025,.01"
orientation="0,0,90"/>
<child link="wheel_fr" position="0,0,0" orientation="0,0,0"/>
</joint>
<joint id="base_wheel_fl" type="revolute" axis="0,0,1">
<parent link="base" position=".025,.025,.01"
orientation="0,0,-90"/>
<child link="wheel_fl" position="0,0,0" orientation="0,0,0"/>
</joint>
<joint id="base_wheel_br" type="revolute" axis="0,0,1">
<parent link="base" position=" -.025,-.025,.01"
orientation="0,0,90"/>
<child link="wheel_br" position="0,0,0" orientation="0,0,0"/>
</joint>
<joint id="base_wheel_bl" type="revolute" axis="0,0,1">
<parent link="base" position=" -.025,.025,.01"
orientation="0,0,-90"/>
<child link="wheel_bl" position="0,0,0" orientation="0,0,0"/>
</joint>
</joints>
</prototype>)";

constexpr const char* vehicle_controller = R"(<controllers><lua_controller id="my_controller">
<actuators >
<joints implementation="default">
<joint id="base_wheel_fr" mode="velocity" max_impulse="0.005f"/>
<joint id="base_wheel_fl" mode="velocity" max_impulse="0.005f"/>
<joint id="base_wheel_br" mode="velocity" max_impulse="0.005f"/>
<joint id="base_wheel_bl" mode="velocity" max_impulse="0.005f"/>
</joints>
</actuators>

<sensors >
<joints implementation="default">
<joint id="base_wheel_fr" mode="velocity"/>
<joint id="base_wheel_fl" mode="velocity"/>
<joint id="base_wheel_br" mode="velocity"/>
<joint id="base_wheel_bl" mode="velocity"/>
</joints>
</sensors>
<params script="path/to/script.lua"/>
</lua_controller></controllers>)";

constexpr const char* repeater = R"(<prototype id="repeater0" movable="true">
<body position="0.06,0.06,0" orientation="-45,0,0" />
<controller config="repeater"/>
<links ref="base">
<link id="base" geometry="box" size=".1,.04,.025" mass="0.1"
position="0,0,0" orientation="0,0,0" />
</links>
<devices >
<radios medium="radio">

<radio id="radio_rx" anchor="base" range="0.09"
position=".05,0,.0125"/>
<radio id="radio_tx" anchor="base" range="0.09"
position=" -.05,0,.0125"/>
</radios>
<leds medium="leds">
<led id="led" anchor="base" color="0,0,0,0" offset="0,0,.025"/>
</leds>
</devices>
</prototype>)";

constexpr const char* repeater_controller = R"(<controllers><lua_controller id="repeater">
<actuators >
<radios implementation="default"/>
<leds implementation="default" medium="leds"/>
</actuators>
<sensors >
<radios implementation="default" show_rays="true"/>
</sensors>
<params script="path/to/prototype -radio -controller.lua"/>

</lua_controller></controllers>)";

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

TEST(Listings, SingleBodyEngine) {
  SceneText text;
  text.engines = single_bodies_engine;
  const ReadResult result = text.read();
  ASSERT_TRUE(result.problems.empty()) << all_problems(result);
  const Physics& physics = result.scene.physics;
  EXPECT_EQ(physics.id, "dyn3d");
  EXPECT_EQ(physics.iterations, 20u);
  ASSERT_TRUE(physics.floor);
  EXPECT_EQ(physics.floor->height, 0.01);
  EXPECT_EQ(physics.gravity, 9.8);
  EXPECT_FALSE(physics.magnetism);
}

TEST(Listings, MagnetismEngine) {
  SceneText text;
  text.engines = magnetism_engine;
  const ReadResult result = text.read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  ASSERT_TRUE(result.scene.physics.magnetism);
  EXPECT_EQ(result.scene.physics.magnetism->max_distance, 0.1);
  EXPECT_EQ(result.scene.physics.magnetism->force_constant, 7.0500949e-13);
}

TEST(Listings, Vehicle) {
  SceneText text;
  text.arena = arena_with(vehicle);
  text.controllers = vehicle_controller;
  const ReadResult result = text.read();
  ASSERT_TRUE(result.problems.empty()) << all_problems(result);
  const Entity& entity = result.scene.entities.at(0);
  ASSERT_EQ(entity.links.size(), 5u);
  EXPECT_EQ(entity.links[3].id, "wheel_br");
  EXPECT_EQ(entity.links[3].offset.position, math::Vector3(-0.025, -0.025, 0.02));
  EXPECT_EQ(std::get<Cylinder>(entity.links[3].geometry).height, 0.005);
  ASSERT_EQ(entity.joints.size(), 4u);
  EXPECT_EQ(entity.joints[0].id, "base_wheel_fr");
  EXPECT_EQ(entity.joints[0].parent, 0u);
  EXPECT_EQ(entity.joints[0].child, 2u);
  EXPECT_EQ(entity.controller, 0u);
  const Controller& controller = result.scene.controllers.at(0);
  ASSERT_EQ(controller.devices.joints.actuators.size(), 4u);
  EXPECT_EQ(controller.devices.joints.actuators[1].joint, "base_wheel_fl");
  EXPECT_EQ(controller.devices.joints.actuators[1].max_impulse, 0.005);
  EXPECT_EQ(controller.devices.joints.actuators[1].mode, JointMode::velocity);
  EXPECT_EQ(controller.devices.joints.sensors.size(), 4u);
  ASSERT_EQ(controller.params.size(), 1u);
  EXPECT_EQ(controller.params[0].second, "path/to/script.lua");
}

TEST(Listings, Repeater) {
  SceneText text;
  text.arena = arena_with(repeater);
  text.controllers = repeater_controller;
  text.media = all_media;
  const ReadResult result = text.read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  const Devices& devices = result.scene.entities.at(0).devices;
  ASSERT_EQ(devices.radios.size(), 2u);
  EXPECT_EQ(devices.radios[1].id, "radio_tx");
  EXPECT_EQ(devices.radios[1].position, math::Vector3(-0.05, 0, 0.0125));
  EXPECT_EQ(devices.radios[1].range, 0.09);
  EXPECT_EQ(devices.radio_medium, 3u);
  EXPECT_EQ(devices.leds.at(0).color, Color{});
  const ControllerDevices& enabled = result.scene.controllers.at(0).devices;
  ASSERT_TRUE(enabled.radios && enabled.leds);
  EXPECT_TRUE(enabled.radios->actuator && enabled.radios->sensor && enabled.radios->show_rays);
  EXPECT_EQ(enabled.leds->medium, 0u);
}

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
