// SPDX-License-Identifier: MIT
// Controllers and directors: their values, and notices about parts without effect.

#include <gtest/gtest.h>

#include <utility>

#include "scene_text.h"

namespace ziggurat::scene {
namespace {

TEST(Controllers, OwnDeadlinesReplaceTheDeadlineOfAll) {
  const auto read = [](const std::string& controllers) {
    SceneText text;
    text.controllers = controllers;
    const ReadResult result = text.read();
    EXPECT_TRUE(result.ok()) << all_problems(result);
    return result.scene.controllers;
  };
  EXPECT_FALSE(read(R"(<controllers><lua_controller id="a"/></controllers>)")[0].deadline);
  const auto controllers =
      read(R"(<controllers deadline="hold" deadline_ms="50" miss_budget="3">)"
           R"(<lua_controller id="a"/><lua_controller id="b" deadline="zero" deadline_ms="20"/>)"
           R"(<lua_controller id="c" deadline="wait"/></controllers>)");
  EXPECT_EQ(controllers[0].deadline, (DeadlinePolicy{DeadlineAction::hold, 50, 3}));
  EXPECT_EQ(controllers[1].deadline, (DeadlinePolicy{DeadlineAction::zero, 20, 0}));
  EXPECT_EQ(controllers[2].deadline,
            DeadlinePolicy{});  // written, so the deadline of all does not replace it
  EXPECT_EQ(read(R"(<controllers><x id="a" deadline="drop" deadline_ms="1"/></controllers>)")[0]
                .deadline->action,
            DeadlineAction::drop);
  EXPECT_EQ(read(R"(<controllers><x id="a" deadline="stop" deadline_ms="1"/></controllers>)")[0]
                .deadline->action,
            DeadlineAction::stop);
}

TEST(Controllers, DeadlinesAsText) {
  EXPECT_EQ(to_text(DeadlinePolicy{}), "wait");
  EXPECT_EQ(to_text({DeadlineAction::hold, 50, 0}), "hold:50");
  EXPECT_EQ(to_text({DeadlineAction::stop, 7, 10}), "stop:7:10");
}

TEST(Directors, AreReadWithWhatStartsThem) {
  SceneText text;
  text.rest = R"(<parameters height="0.3"/><director id="judge" script="judge.lua" deadline="drop")"
              R"( deadline_ms="9"><params height="${height}"/></director>)"
              R"(<director id="feeder" command="./feed"/><loop_functions script="rule.lua"/>)";
  const ReadResult result = text.read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  const auto& directors = result.scene.directors;
  ASSERT_EQ(directors.size(), 3u);
  EXPECT_EQ(directors[0].id, "judge");
  EXPECT_EQ(directors[0].script, "judge.lua");
  EXPECT_EQ(directors[0].deadline, (DeadlinePolicy{DeadlineAction::drop, 9, 0}));
  EXPECT_EQ(directors[0].params.at(0).second, "0.3");
  EXPECT_EQ(directors[1].command, "./feed");
  EXPECT_EQ(directors[1].params.at(0).second, "0.3") << "the scene's parameters are all directors'";
  EXPECT_EQ(directors[2].id, "loop_functions");
  EXPECT_EQ(directors[2].script, "rule.lua");
  EXPECT_NE(
      all_problems(result).find("<loop_functions> is read as <director id=\"loop_functions\">"),
      std::string::npos);
}

TEST(Directors, OneNeedsNoId) {
  SceneText text;
  text.rest = R"(<director script="judge.lua"/><director id="feeder" command="./feed"/>)";
  const ReadResult result = text.read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  EXPECT_EQ(result.scene.directors.at(0).id, "director");
}

TEST(Directors, HaveNoIdOfAnEntity) {
  SceneText text;
  text.rest = R"(<director id="p" command="./feed"/>)";
  text.arena =
      R"(<arena size="2,2,1" center="0,0,0.5"><prototype id="p" movable="false"><links ref="l">)"
      R"(<link id="l" geometry="box" size="1,1,1" mass="1"/></links><body/></prototype></arena>)";
  const ReadResult result = text.read();
  EXPECT_NE(
      all_problems(result).find("id=\"p\" of <prototype> is also the id of the director at line "),
      std::string::npos)
      << all_problems(result);
}

TEST(Controllers, KindsAndParams) {
  SceneText text;
  text.controllers = R"(<controllers>
<lua_controller id="l"><actuators/><sensors/><params script=" a b.lua " gain="2"/></lua_controller>
<external_controller id="e" command="./drive --fast"><actuators/><sensors/></external_controller>
<footbot_diffusion_controller id="c" library="x.so"><actuators/><sensors/><params alpha="7"><deep/></params></footbot_diffusion_controller>
</controllers>)";
  const ReadResult result = text.read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  const auto& controllers = result.scene.controllers;
  ASSERT_EQ(controllers.size(), 3u);
  EXPECT_TRUE(controllers[0].lua);
  EXPECT_EQ(controllers[0].params[0], std::pair(std::string("script"), std::string("a b.lua")));
  EXPECT_EQ(controllers[0].params[1].second, "2");
  EXPECT_EQ(controllers[0].params_where.line, 4u);
  EXPECT_EQ(controllers[0].params_where.column, 46u);
  EXPECT_FALSE(controllers[1].lua);
  EXPECT_EQ(controllers[1].command, "./drive --fast");
  EXPECT_EQ(controllers[2].type, "footbot_diffusion_controller");
  EXPECT_EQ(count_containing(notices(result),
                             "6:1: <footbot_diffusion_controller> is a library in C++, which is "
                             "not loaded into the server; the run waits for a client in its place, "
                             "or with --lenient its robots stand still: write its rule in Lua as "
                             "<lua_controller>, or as a program in C++ or Python and add "
                             "--controller c=COMMAND"),
            1u)
      << all_problems(result);
  EXPECT_EQ(count_containing(notices(result), "library of"), 0u);
  EXPECT_EQ(
      count_containing(notices(text.read({.lenient = true})), "server; its robots stand still"),
      1u);
  EXPECT_EQ(count_containing(notices(result), "elements in <params> have no effect"), 1u);
}

TEST(Controllers, AMisspeltOneIsAFault) {
  const auto told = [](const std::string& name) {
    const auto result =
        read_text("<a><controllers><" + name + " id=\"c\"><actuators/><sensors/></" + name +
                      "></controllers></a>",
                  "a.argos");
    return count_containing(
        faults(result),
        "unknown element <" + name + "> in <controllers>; did you mean <lua_controller>?");
  };
  EXPECT_EQ(told("lua_controler"), 1u);
  EXPECT_EQ(told("lua-controller"), 1u);
  EXPECT_EQ(told("luacontroller"), 1u);
  EXPECT_EQ(told("epuck_controller"), 0u);
}

TEST(Controllers, EveryNameOfTheDialectIsKnown) {
  const char* actuators[] = {"joints",
                             "radios",
                             "leds",
                             "directional_leds",
                             "tags",
                             "magnets",
                             "differential_steering",
                             "gripper",
                             "range_and_bearing",
                             "quadrotor_position",
                             "quadrotor_speed",
                             "footbot_turret",
                             "footbot_gripper",
                             "footbot_distance_scanner",
                             "wifi",
                             "epuck_wheels",
                             "epuck_leds",
                             "epuck_range_and_bearing"};
  const std::pair<const char*, const char*> sensors[] = {
      {"joints", "default"},
      {"radios", "default"},
      {"cameras", "default"},
      {"proximity", "default"},
      {"positioning", "default"},
      {"differential_steering", "default"},
      {"battery", "default"},
      {"ground", "rot_z_only"},
      {"light", "default"},
      {"range_and_bearing", "medium"},
      {"colored_blob_omnidirectional_camera", "rot_z_only"},
      {"colored_blob_perspective_camera", "default"},
      {"footbot_proximity", "default"},
      {"footbot_light", "rot_z_only"},
      {"footbot_base_ground", "rot_z_only"},
      {"footbot_motor_ground", "rot_z_only"},
      {"footbot_turret_encoder", "default"},
      {"footbot_distance_scanner", "rot_z_only"},
      {"wifi", "default"},
      {"epuck_wheels", "default"},
      {"epuck_proximity", "default"},
      {"epuck_light", "rot_z_only"},
      {"epuck_ground", "rot_z_only"},
      {"epuck_range_and_bearing", "medium"}};
  std::string list = "<controllers><lua_controller id=\"c\"><actuators>";
  for (const std::string name : actuators) {
    list += "<" + name + " implementation=\"default\"" +
            (name.ends_with("leds") && name != "directional_leds" ? " medium=\"leds\"/>" : "/>");
  }
  list += "</actuators><sensors>";
  for (const auto& [name, implementation] : sensors) {
    const std::string n = name;
    list += "<" + n + " implementation=\"" + implementation + "\"" +
            (n.ends_with("range_and_bearing") ? " medium=\"rab\"/>"
             : n.starts_with("colored_blob")  ? " medium=\"leds\"/>"
                                              : "/>");
  }
  SceneText text;
  text.controllers = list + "</sensors><params/></lua_controller></controllers>";
  text.media = R"(<media><led id="leds"/><range_and_bearing id="rab"/></media>)";
  const ReadResult result = text.read();
  EXPECT_TRUE(result.ok()) << all_problems(result);
  const auto& described = result.scene.controllers.at(0).devices.described;
  EXPECT_EQ(described.size(), 13u) << "scanner, quadrotor and gripper are one device each";
  const auto scanner =
      std::ranges::find(described, "footbot_distance_scanner", &DescribedUse::kind);
  ASSERT_NE(scanner, described.end());
  EXPECT_TRUE(scanner->actuator && scanner->sensor);
}

SceneText with_imus(const std::string& imus) {
  SceneText text;
  text.controllers =
      R"(<controllers><lua_controller id="c"><actuators/><sensors><imus implementation="default">)" +
      imus + "</imus></sensors><params/></lua_controller></controllers>";
  return text;
}

TEST(Controllers, Imus) {
  const ReadResult result =
      with_imus(R"(<imu id="a" anchor="origin"/><imu id="b" anchor="base" position="1,2,3")"
                R"( orientation="90,0,0" acceleration_noise="0.1" acceleration_bias_walk="0.2")"
                R"( angular_velocity_noise="0.3" angular_velocity_bias_walk="0.4"/>)")
          .read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  const std::vector<Imu>& imus = result.scene.controllers[0].devices.imus;
  ASSERT_EQ(imus.size(), 2u);
  EXPECT_EQ(imus[0].acceleration_noise, 0);
  EXPECT_EQ(imus[1].anchor, "base");
  EXPECT_EQ(imus[1].pose.position, math::Vector3(1, 2, 3));
  EXPECT_NEAR((imus[1].pose.orientation * math::Vector3::UnitX()).y(), 1, 1e-12);
  EXPECT_EQ(imus[1].acceleration_noise, 0.1);
  EXPECT_EQ(imus[1].acceleration_bias_walk, 0.2);
  EXPECT_EQ(imus[1].angular_velocity_noise, 0.3);
  EXPECT_EQ(imus[1].angular_velocity_bias_walk, 0.4);
}

TEST(Controllers, ContactSensors) {
  SceneText text;
  text.controllers =
      R"(<controllers><lua_controller id="c"><actuators/><sensors>)"
      R"(<contact_sensors implementation="default"><contact_sensor id="a" anchor="base"/>)"
      R"(<contact_sensor id="b" anchor="origin"/></contact_sensors></sensors><params/>)"
      R"(</lua_controller></controllers>)";
  const ReadResult result = text.read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  const auto& sensors = result.scene.controllers[0].devices.contact_sensors;
  ASSERT_EQ(sensors.size(), 2u);
  EXPECT_EQ(sensors[0].anchor, "base");
  EXPECT_EQ(sensors[1].id, "b");
}

TEST(Controllers, ImusWithFaults) {
  const std::pair<const char*, const char*> faults[] = {
      {"", "has no sensor; write <imu"},
      {R"(<imu id="a"/>)", "anchor"},
      {R"(<imu id="a" anchor="origin"/><imu id="a" anchor="origin"/>)", "earlier imu"},
      {R"(<imu id="a" anchor="origin" acceleration_noise="-1"/>)", "acceleration_noise"},
      {R"(<imu id="a" anchor="origin" noise="1"/>)", "noise"},
      {R"(<gyroscope/>)", "gyroscope"}};
  for (const auto& [imus, words] : faults) {
    const ReadResult result = with_imus(imus).read();
    EXPECT_FALSE(result.ok()) << imus;
    EXPECT_NE(all_problems(result).find(words), std::string::npos) << all_problems(result);
  }
}

TEST(Controllers, AttributesWithoutEffectGiveNotices) {
  SceneText text;
  text.controllers =
      R"(<controllers><lua_controller id="c"><actuators><radios implementation="default" medium="r"/>)"
      R"(</actuators><sensors><radios implementation="default" medium="r"/></sensors><params/>)"
      R"(</lua_controller></controllers>)";
  const ReadResult result = text.read();
  EXPECT_TRUE(result.ok()) << all_problems(result);
  EXPECT_EQ(count_containing(notices(result), "medium of <radios> has no effect here"), 1u);
}

TEST(Controllers, TheLastOfTwoDevicesIsUsed) {
  SceneText text;
  text.controllers = R"(<controllers><lua_controller id="c"><actuators/><sensors>)"
                     R"(<joints implementation="default"><joint id="a" mode="position"/></joints>)"
                     R"(<joints implementation="default"><joint id="b" mode="position"/></joints>)"
                     R"(</sensors><params/></lua_controller></controllers>)";
  const ReadResult result = text.read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  const auto& joints = result.scene.controllers[0].devices.joints.sensors;
  ASSERT_EQ(joints.size(), 1u);
  EXPECT_EQ(joints[0].joint, "b");
  EXPECT_EQ(count_containing(notices(result), "this <joints> has no effect"), 1u);
}

}  // namespace
}  // namespace ziggurat::scene
