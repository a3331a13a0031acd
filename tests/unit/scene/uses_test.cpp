// SPDX-License-Identifier: MIT
// Devices that controllers use must be on their robots; robots with a fixed set of devices.

#include <gtest/gtest.h>

#include <numbers>

#include "scene_text.h"

namespace ziggurat::scene {
namespace {

SceneText with_controller(const std::string& actuators, const std::string& sensors,
                          const std::string& params = "<params/>") {
  SceneText text;
  text.controllers = "<controllers><lua_controller id=\"c\"><actuators>\n" + actuators +
                     "</actuators><sensors>\n" + sensors + "</sensors>" + params +
                     "</lua_controller></controllers>";
  std::string robots;
  for (const char* id : {"p1", "p2"}) {
    robots += tree(link("base") + link("arm") + link("ball"),
                   joint("j", "base", "arm", "type=\"revolute\" axis=\"0,0,1\"") +
                       joint("s", "arm", "ball", "type=\"spherical\""),
                   "<controller config=\"c\"/>", "id=\"" + std::string(id) + "\"");
  }
  text.arena = arena_with(robots);
  return text;
}

TEST(Uses, MotorsHaveAForceOrATorque) {
  const ReadResult good =
      with_controller(R"(<joints implementation="default">)"
                      R"(<joint id="j" mode="velocity" max_torque="2"/></joints>)",
                      "")
          .read();
  ASSERT_TRUE(good.ok()) << all_problems(good);
  const JointActuator& motor = good.scene.controllers[0].devices.joints.actuators[0];
  EXPECT_EQ(motor.max_force, 2.0);
  const auto found =
      faults(with_controller(R"(<joints implementation="default">)"
                             R"(<joint id="j" mode="velocity" max_force="2"/></joints>)",
                             "")
                 .read());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].find("is revolute; write max_torque instead of max_force"), std::string::npos);
  const auto both = faults(
      with_controller(R"(<joints implementation="default">)"
                      R"(<joint id="j" mode="velocity" max_torque="2" max_impulse="1"/></joints>)",
                      "")
          .read());
  ASSERT_EQ(both.size(), 1u);
  EXPECT_NE(both[0].find("write one"), std::string::npos);
}

TEST(Uses, JointsMustExistAndMove) {
  const SceneText text =
      with_controller(R"(<joints implementation="default">)"
                      R"(<joint id="j" mode="velocity" max_impulse="1"/>)"
                      R"(<joint id="k" mode="velocity" max_impulse="1"/>)"
                      R"(<joint id="s" mode="velocity" max_impulse="1"/></joints>)",
                      R"(<joints implementation="default"><joint id="jj" mode="position"/>)"
                      R"(<joint id="s" mode="position"/></joints>)");
  const ReadResult result = text.read();
  const auto found = faults(result);
  ASSERT_EQ(found.size(), 3u) << all_problems(result);  // once each, though two robots use it
  EXPECT_EQ(count_containing(found, "4:81: joint \"k\" does not exist in prototype \"p1\""), 1u);
  EXPECT_EQ(count_containing(found, "joint \"s\" of prototype \"p1\" is spherical"), 1u);
  EXPECT_EQ(count_containing(found,
                             "joint \"jj\" does not exist in prototype \"p1\"; did you mean "
                             "\"j\"?"),
            1u);
  EXPECT_EQ(count_containing(notices(result), "the sensor of joint \"s\" always reads 0"), 1u);
}

TEST(Uses, ComponentsMustExist) {
  const ReadResult result = with_controller(R"(<radios implementation="default"/>)",
                                            R"(<footbot_turret_encoder implementation="default"/>)"
                                            R"(<positioning implementation="default"/>)")
                                .read();
  const auto found = faults(result);
  ASSERT_EQ(found.size(), 2u) << all_problems(result);
  EXPECT_EQ(count_containing(found,
                             "4:1: radios are enabled for entity \"p1\", which has none; "
                             "write <radios> into its <devices>"),
            1u);
  EXPECT_EQ(count_containing(found, "footbot_turret_encoder is enabled"), 1u);
}

TEST(Uses, CameraAnchorsMustExist) {
  const ReadResult result =
      with_controller(
          "", R"(<cameras implementation="default"><camera id="k" range="0.1:1" anchor="turret")"
              R"( position="0,0,0" orientation="0,0,0" focal_length="1,1" principle_point="1,1")"
              R"( resolution="10,10"/></cameras>)")
          .read();
  const auto found = faults(result);
  ASSERT_EQ(found.size(), 1u) << all_problems(result);
  EXPECT_EQ(count_containing(found, "anchor \"turret\" of camera \"k\" does not exist"), 1u);
}

TEST(Uses, CameraAnchorsMustExistOnFootBotAndEPuck) {
  SceneText text =
      with_controller("", R"(<cameras implementation="default"><camera id="k" range="0.1:1")"
                          R"( anchor="gripper" position="0,0,0" orientation="0,0,0")"
                          R"( focal_length="1,1" principle_point="1,1" resolution="10,10"/>)"
                          R"(</cameras>)");
  const std::string controller = R"(<body/><controller config="c"/>)";
  text.arena = arena_with(R"(<foot-bot id="f">)" + controller + "</foot-bot>");
  auto found = faults(text.read());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(
      count_containing(found, "anchor \"gripper\" of camera \"k\" does not exist in foot-bot"), 1u);
  for (const char* anchor : {"origin", "base", "turret", "perspective_camera"}) {
    EXPECT_EQ(count_containing(found, anchor), 1u) << found[0];
  }
  text.arena = arena_with(R"(<e-puck id="e">)" + controller + "</e-puck>");
  found = faults(text.read());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(count_containing(found, "does not exist in e-puck \"e\""), 1u);
}

TEST(Uses, SectionsMustExist) {
  SceneText text = with_controller("", "");
  text.controllers = "<controllers><lua_controller id=\"c\"/></controllers>";
  const auto found = faults(text.read());
  EXPECT_EQ(found.size(), 3u);
  EXPECT_EQ(count_containing(found, "3:14: controller \"c\" lacks the element <actuators>"), 1u);
  EXPECT_EQ(count_containing(found, "lacks the element <sensors>"), 1u);
  EXPECT_EQ(count_containing(found, "lacks the element <params>"), 1u);
}

TEST(Uses, AnEntitysOwnParamsReplaceTheControllers) {
  SceneText text = with_controller("", "", "");
  text.arena = arena_with(
      tree(link("base"), "",
           R"(<controller config="c"><params script="own.lua" anything="goes"/></controller>)"));
  const ReadResult result = text.read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  const Entity& entity = result.scene.entities[0];
  EXPECT_TRUE(entity.overrides_params);
  ASSERT_EQ(entity.params.size(), 2u);
  EXPECT_EQ(entity.params[1], std::pair(std::string("anything"), std::string("goes")));
  EXPECT_FALSE(with_controller("", "", "").read().ok());
}

TEST(Robots, FootBotHasTheDialectsGeometryAndDevices) {
  SceneText text = with_controller("", "");
  text.arena =
      arena_with(R"(<foot-bot id="f" rab_range="2" rab_data_size="4"><body position="1,2,0"/>)"
                 R"(<battery start_charge="0.5"/><controller config="c"/><dynamics2d>)"
                 R"(<differential_steering max_force="7"/></dynamics2d></foot-bot>)");
  const ReadResult result = text.read();
  ASSERT_TRUE(result.problems.empty()) << all_problems(result);
  const Entity& robot = result.scene.entities.at(0);
  EXPECT_EQ(std::get<Cylinder>(robot.links.at(0).geometry).radius, 0.085036758);
  EXPECT_EQ(robot.links.at(1).id, "turret");
  EXPECT_EQ(robot.turret, 1u);
  EXPECT_EQ(robot.links.at(2).id, "perspective_camera");
  EXPECT_FALSE(robot.links[2].collides);
  EXPECT_EQ(robot.axle_length, 0.14);
  EXPECT_EQ(robot.traction->max_force, 7);
  EXPECT_EQ(robot.traction->max_torque, 150);
  ASSERT_EQ(robot.devices.leds.size(), 13u);
  EXPECT_EQ(robot.devices.leds[0].anchor.link, 1);
  EXPECT_NEAR(robot.devices.leds[3].offset.x(),
              0.090036758 * std::cos(105 * std::numbers::pi / 180), 1e-15);
  EXPECT_EQ(robot.devices.leds[12].offset, math::Vector3(0, 0, 0.174249733));
  ASSERT_EQ(robot.devices.proximity_sensors.size(), 24u);
  EXPECT_NEAR(robot.devices.proximity_sensors[1].direction.y(),
              std::sin(22.5 * std::numbers::pi / 180), 1e-15);
  EXPECT_EQ(robot.devices.range_and_bearing->range, 2);
  EXPECT_EQ(robot.devices.range_and_bearing->data_size, 4u);
  EXPECT_EQ(robot.devices.battery->start_charge, 0.5);
}

TEST(Robots, HaveABatteryThatNothingDischargesWhereTheSceneHasNone) {
  SceneText text = with_controller("", R"(<battery implementation="default"/>)");
  text.arena = arena_with(R"(<foot-bot id="f"><body/><controller config="c"/></foot-bot>)");
  const ReadResult result = text.read();
  ASSERT_TRUE(result.problems.empty()) << all_problems(result);
  const Battery& battery = *result.scene.entities.at(0).devices.battery;
  EXPECT_EQ(battery.start_charge, 1);
  EXPECT_EQ(battery.per_tick + battery.per_metre + battery.per_radian, 0);
}

TEST(Robots, EPuckMatchesItsDataSheet) {
  SceneText text = with_controller("", "");
  text.arena = arena_with(R"(<e-puck id="e"><body/><controller config="c"/></e-puck>)");
  const ReadResult result = text.read();
  ASSERT_TRUE(result.problems.empty()) << all_problems(result);
  const Entity& robot = result.scene.entities.at(0);
  EXPECT_EQ(std::get<Cylinder>(robot.links.at(0).geometry).radius, 0.035);
  EXPECT_EQ(robot.axle_length, 0.053);
  EXPECT_FALSE(robot.turret);
  EXPECT_EQ(robot.devices.leds.size(), 10u) << "a ring of 8, body and front";
  ASSERT_EQ(robot.devices.proximity_sensors.size(), 8u);
  EXPECT_LT(robot.devices.proximity_sensors[0].direction.y(), 0);  // PS0 is on the right
  EXPECT_GT(robot.devices.proximity_sensors[7].direction.y(), 0);
}

TEST(Robots, ReportAllTheirFaults) {
  SceneText text = with_controller("", "");
  text.arena =
      arena_with(R"(<foot-bot id="f" rab_range="-1" omnidirectional_camera_aperture="80"><body/>)"
                 R"(<dynamics2d><differential_steering max_force="0"/></dynamics2d></foot-bot>)");
  const auto found = faults(text.read());
  EXPECT_EQ(found.size(), 3u);
  EXPECT_EQ(count_containing(found, "rab_range=\"-1\""), 1u);
  EXPECT_EQ(count_containing(found, "max_force=\"0\""), 1u);
  EXPECT_EQ(count_containing(found, "<foot-bot> lacks"), 1u);
  text.arena =
      arena_with(R"(<eye-bot id="e" camera_aperture="90"><body/></eye-bot>)"
                 R"(<kilobot id="k" left_motor="0" communication_range="-1"><body/></kilobot>)");
  const auto others = faults(text.read());
  EXPECT_EQ(others.size(), 5u);
  EXPECT_EQ(count_containing(others, "camera_aperture=\"90\" of <eye-bot> must be more"), 1u);
  EXPECT_EQ(count_containing(others, "left_motor=\"0\" of <kilobot>"), 1u);
}

TEST(Robots, HaveOnlyTheirOwnDevices) {
  const auto lacks = [](const std::string& device, const std::string& robot) {
    SceneText text = with_controller("<" + device + R"( implementation="default"/>)", "");
    text.arena =
        arena_with("<" + robot + R"( id="r"><body/><controller config="c"/></)" + robot + ">");
    return count_containing(faults(text.read()), " enabled for entity \"r\"");
  };
  EXPECT_EQ(lacks("differential_steering", "foot-bot"), 0u);
  EXPECT_EQ(lacks("differential_steering", "e-puck"), 0u);
  EXPECT_EQ(lacks("footbot_turret", "foot-bot"), 0u);
  EXPECT_EQ(lacks("footbot_turret", "e-puck"), 1u);
  EXPECT_EQ(lacks("radios", "e-puck"), 1u);
  EXPECT_EQ(lacks("wifi", "foot-bot"), 0u);
  EXPECT_EQ(lacks("wifi", "pipuck"), 0u);
  EXPECT_EQ(lacks("wifi", "builderbot"), 0u);
  EXPECT_EQ(lacks("wifi", "e-puck"), 1u);
  EXPECT_EQ(lacks("quadrotor_speed", "foot-bot"), 1u);
  EXPECT_EQ(lacks("quadrotor_speed", "spiri"), 0u);
  EXPECT_EQ(lacks("range_and_bearing", "mini-quadrotor"), 1u);
  EXPECT_EQ(lacks("differential_steering", "eye-bot"), 1u);
  EXPECT_EQ(lacks("kilobot_led", "kilobot"), 0u);
  EXPECT_EQ(lacks("kilobot_led", "e-puck"), 1u);
  EXPECT_EQ(lacks("pipuck_differential_drive", "e-puck"), 1u);
  EXPECT_EQ(lacks("pipuck_leds", "pipuck"), 0u);
  EXPECT_EQ(lacks("builderbot_lift_system", "builderbot"), 0u);
  EXPECT_EQ(lacks("builderbot_electromagnet_system", "block"), 1u);
  EXPECT_EQ(lacks("gripper", "foot-bot"), 0u);
  EXPECT_EQ(lacks("gripper", "e-puck"), 1u);
  EXPECT_EQ(lacks("epuck_wheels", "e-puck"), 0u);
  EXPECT_EQ(lacks("epuck_wheels", "foot-bot"), 1u);
}

TEST(Robots, SomeDevicesHaveTwoImplementations) {
  const auto told = [](const std::string& implementation) {
    SceneText text =
        with_controller("", R"(<kilobot_light implementation=")" + implementation + R"("/>)");
    text.arena = arena_with(R"(<kilobot id="k"><body/><controller config="c"/></kilobot>)");
    return faults(text.read());
  };
  EXPECT_TRUE(told("rot_z_only").empty());
  EXPECT_TRUE(told("default").empty());
  ASSERT_EQ(told("rot").size(), 1u);
  EXPECT_NE(told("rot")[0].find("write one of: rot_z_only, default"), std::string::npos);
}

}  // namespace
}  // namespace ziggurat::scene
