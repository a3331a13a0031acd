// SPDX-License-Identifier: MIT
// Entities added to a scene after it was read.

#include <gtest/gtest.h>

#include "scene_text.h"

namespace ziggurat::scene {
namespace {

constexpr std::size_t ample = 1 << 20;

const std::string box =
    R"(<box id="crate" size=".1,.2,.3" movable="true" mass="2"><body position="1,2,0"/></box>)";

SceneText scene_with_everything() {
  SceneText text;
  text.controllers =
      R"(<controllers><lua_controller id="lua"><actuators/><sensors/><params script="a.lua"/>)"
      R"(</lua_controller><external_controller id="wheels"><actuators>)"
      R"(<differential_steering implementation="default"/></actuators><sensors/><params/>)"
      R"(</external_controller></controllers>)";
  text.arena = arena_with(R"(<box id="wall" size="1,1,1" movable="false"><body position="0,0,0"/>)"
                          R"(</box>)");
  text.engines =
      R"(<physics_engines><dynamics3d id="dyn" default_friction="7"/></physics_engines>)";
  text.media = R"(<media><tag id="tags"/><led id="leds"/><range_and_bearing id="rab"/></media>)";
  text.rest =
      R"(<models><prototype id="block"><links ref="core"><link id="core" geometry="box" )"
      R"(size="1,1,1" mass="2"/></links><devices><tags medium="tags"><tag anchor="core" )"
      R"(position="0,0,1" orientation="0,0,0" payload="7" side_length="0.1" )"
      R"(observable_angle="90"/></tags></devices><controller config="lua"/></prototype></models>)";
  return text;
}

class Additions : public ::testing::Test {
 protected:
  explicit Additions(const SceneText& text = scene_with_everything())
      : scene_(text.read({.lenient = true})) {
    EXPECT_TRUE(scene_.ok()) << all_problems(scene_);
  }

  Addition add(const std::string& text, std::size_t max_size = ample) const {
    return scene_.additions.read(text, scene_.scene, max_size,
                                 [](const std::string& id) { return id == "wall"; });
  }
  std::string fault(const std::string& text, std::size_t max_size = ample) const {
    const Addition addition = add(text, max_size);
    EXPECT_FALSE(addition.ok()) << text;
    return addition.problems.empty() ? "" : to_string(addition.problems[0]);
  }

  ReadResult scene_;
};

TEST_F(Additions, ALenientSceneLendsTheMediumThatTheyDoNotName) {
  const Addition light =
      add(R"(<light id="l" position="0,0,1" color="red" intensity="1" medium="none"/>)");
  ASSERT_TRUE(light.ok());
  EXPECT_EQ(light.entity.devices.led_medium, 1u);
  const std::string why = fault(R"(<prototype id="p"><body/><links ref="a"><link id="a" )"
                                R"(geometry="sphere" radius="1" mass="1"/></links><devices>)"
                                R"(<radios medium="none"/></devices></prototype>)");
  EXPECT_NE(why.find("names no medium"), std::string::npos) << why;
}

TEST_F(Additions, ABoxIsReadAsInTheArena) {
  const Addition addition = add("\n  " + box);
  ASSERT_TRUE(addition.ok());
  EXPECT_EQ(addition.entity.id, "crate");
  EXPECT_EQ(addition.entity.kind, EntityKind::box);
  EXPECT_EQ(addition.entity.pose.position, math::Vector3(1, 2, 0));
  EXPECT_EQ(addition.entity.links.at(0).mass, 2);
  EXPECT_EQ(addition.entity.where, (Location{1, 2, 3}));
  EXPECT_EQ(file_of(scene_.scene, addition.entity.where), "spawn");
  EXPECT_EQ(addition.size, box.size() + 3);
  EXPECT_EQ(scene_.scene.files.size(), 1u) << "the scene does not change";
}

TEST_F(Additions, AModelGivesDevicesAndController) {
  const Addition addition = add(
      R"(<prototype id="p" model="block" movable="false"><body position="0,0,3"/></prototype>)");
  ASSERT_TRUE(addition.ok());
  EXPECT_EQ(addition.entity.model, 0u);
  EXPECT_EQ(addition.entity.controller, 0u);
  EXPECT_FALSE(addition.entity.movable);
  ASSERT_EQ(addition.entity.devices.tags.size(), 1u);
  EXPECT_EQ(addition.entity.devices.tags[0].payload, "7");
  EXPECT_GT(addition.size, 250u) << "the model counts as if it were written out";
}

TEST_F(Additions, ARobotUsesAControllerOfTheScene) {
  const Addition addition =
      add(R"(<foot-bot id="fb"><body position="0,0,0"/><controller config="wheels">)"
          R"(<params speed="3"/></controller></foot-bot>)");
  ASSERT_TRUE(addition.ok());
  EXPECT_EQ(addition.entity.controller, 1u);
  EXPECT_EQ(addition.entity.params.at(0).second, "3");
  EXPECT_EQ(addition.entity.devices.range_and_bearing_medium, 2u);
}

TEST_F(Additions, HaveTheSameFaultsAsInTheArena) {
  EXPECT_EQ(
      fault("<box id="),
      "spawn:1:9: malformed XML: the file ends too early, in the tag <box> of line 1; complete "
      "it, and close every element that was opened");
  EXPECT_EQ(fault("<box id=\"x\"\n movable=\"maybe\" size=\"1,1,1\" mass=\"1\"><body "
                  "position=\"0,0,0\"/></box>"),
            "spawn:2:11: movable=\"maybe\" of <box> is not a truth value; write true or false (in "
            "box \"x\")");
  EXPECT_EQ(fault(R"(<prototype id="p" model="blok"><body position="0,0,3"/></prototype>)"),
            "spawn:1:26: model=\"blok\" of <prototype> names no model; did you mean \"block\"? (in "
            "prototype \"p\" of model \"blok\")");
  EXPECT_EQ(fault(R"(<foot-bot id="fb"><body/><controller config="whels"/></foot-bot>)"),
            "spawn:1:46: config=\"whels\" of <controller> names no controller; did you mean "
            "\"wheels\"? (in foot-bot \"fb\")");
  EXPECT_EQ(fault(box + box), "spawn:1:87: a second root element, <box>; a file has one");
}

TEST_F(Additions, MustBeEntitiesWithABody) {
  for (const std::string name : {"distribute", "floor", "argos-configuration", "bax"}) {
    EXPECT_EQ(fault("<" + name + "/>").substr(0, 28 + name.size()),
              "spawn:1:1: unknown element <" + name)
        << name;
  }
}

TEST_F(Additions, ThatAreEmptyAreToldWhatToWrite) {
  for (const std::string text : {"", "\n", "box"}) {
    EXPECT_EQ(fault(text).substr(0, 60),
              "spawn: there is no element; write one, such as <box id=\"b\" s")
        << text;
  }
}

TEST_F(Additions, NeedANewId) {
  EXPECT_EQ(fault(R"(<box id="wall" size="1,1,1" movable="false"><body position="5,0,0"/></box>)"),
            "spawn:1:10: id=\"wall\" of <box> is the id of another entity; give each its own");
}

TEST_F(Additions, ReportTheSameFaultsTheSecondTime) {
  const std::string wrong = R"(<box id="b" size="1,1,1" movable="false"><body position="5,0,0"/>)"
                            R"(<controller config="wheels"/></box>)";
  const std::string unlike =
      R"(<prototype id="p" model="block"><body position="0,0,3"/><controller config="wheels"/>)"
      R"(</prototype>)";
  EXPECT_EQ(fault(wrong), fault(wrong));
  const Addition first = add(unlike), second = add(unlike);  // a lenient one goes without wheels
  EXPECT_TRUE(first.ok());
  ASSERT_FALSE(first.problems.empty());
  ASSERT_FALSE(second.problems.empty());
  EXPECT_EQ(to_string(first.problems[0]), to_string(second.problems[0]));
}

TEST_F(Additions, HaveALimitedSize) {
  EXPECT_TRUE(add(box, box.size()).ok());
  EXPECT_EQ(fault(box, 50).substr(0, 42), "spawn: the file is larger than 50 bytes; s");
  const std::string small =
      R"(<prototype id="p" model="block"><body position="0,0,3"/></prototype>)";
  EXPECT_NE(fault(small, 100).find("is one too many"), std::string::npos);
}

TEST_F(Additions, HaveElementsOf1000AttributesAtMost) {
  std::string params;
  for (int i = 0; i < 1000; ++i) params += " a" + std::to_string(i) + "='1'";
  const auto robot = [&](const std::string& more) {
    return "<prototype id='p' model='block'><body position='0,0,3'/><controller "
           "config='lua'><params" +
           params + more + "/></controller></prototype>";
  };
  EXPECT_TRUE(add(robot("")).ok());
  EXPECT_EQ(fault(robot(" b='1'")),
            "spawn:1:82: <params> has more than 1000 attributes; write fewer");
}

TEST_F(Additions, WithManyMistakesAreNotReadToTheirEnd) {
  std::string links, joints;
  for (int i = 0; i < 300; ++i) {
    const std::string name = std::string(60, 'x') + std::to_string(i);
    links += "<link id='" + name + "' geometry='sphere' radius='1' mass='1'/>";
    joints +=
        "<joint type='fixed'><parent link='y" + name + "'/><child link='z" + name + "'/></joint>";
  }
  const Addition addition =
      add("<prototype id='p'><body position='0,0,0'/><links ref='" + std::string(60, 'x') + "0'>" +
          links + "</links><joints>" + joints + "</joints></prototype>");
  ASSERT_EQ(addition.problems.size(), 21u);
  EXPECT_NE(to_string(addition.problems.back()).find("20 faults; the rest"), std::string::npos);
}

TEST(AdditionsOf, ASceneWithoutEngineAreRefused) {
  SceneText text;
  text.engines = "<physics_engines/>";
  const ReadResult scene = text.read();
  ASSERT_TRUE(scene.ok()) << all_problems(scene);
  const Addition addition =
      scene.additions.read(box, scene.scene, ample, [](const std::string&) { return false; });
  ASSERT_FALSE(addition.ok());
  EXPECT_EQ(
      to_string(addition.problems[0]),
      "spawn:1:1: <box> needs an engine, and the scene has none; write <dynamics3d id=\"…\"/> into "
      "its <physics_engines>");
}

}  // namespace
}  // namespace ziggurat::scene
