// SPDX-License-Identifier: MIT
// Models that many entities share.

#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <iterator>

#include "checkout/checkout.h"
#include "model_files.h"

namespace ziggurat::scene {
namespace {

TEST(Models, DefineTheEntitiesThatUseThem) {
  const ReadResult result =
      read_block(R"(<prototype id="a" model="block"><body position="1,2,3"/></prototype>)"
                 R"(<prototype id="b" model="block"><body orientation="90,0,0"/></prototype>)");
  ASSERT_TRUE(result.ok()) << all_problems(result);
  const Scene& scene = result.scene;
  ASSERT_EQ(scene.entities.size(), 2u);
  EXPECT_EQ(scene.entities[0].id, "a");
  EXPECT_EQ(scene.entities[0].pose.position, math::Vector3(1, 2, 3));
  EXPECT_EQ(scene.entities[0].where.line, 5u);
  EXPECT_EQ(scene.entities[0].where.file, 0u);
  EXPECT_EQ(scene.entities[1].pose.position, math::Vector3(0, 0, 0));
  for (const Entity& entity : scene.entities) {
    EXPECT_EQ(entity.kind, EntityKind::prototype);
    EXPECT_TRUE(entity.movable);
    ASSERT_EQ(entity.links.size(), 2u);
    EXPECT_EQ(entity.links[0].mass, 2.0);
    EXPECT_EQ(entity.links[1].where.line, 9u);
    EXPECT_EQ(entity.links[1].where.file, 1u);
    ASSERT_EQ(entity.joints.size(), 1u);
    EXPECT_EQ(entity.joints[0].child, 1u);
    ASSERT_EQ(entity.devices.leds.size(), 1u);
    EXPECT_EQ(entity.devices.leds[0].anchor.link, 1);
    EXPECT_EQ(entity.devices.led_medium, 0u);
    EXPECT_EQ(entity.model, 0u);
  }
  ASSERT_EQ(scene.models.size(), 1u);
  EXPECT_EQ(scene.models[0].id, "block");
  EXPECT_EQ(scene.models[0].where.line, 6u);
  EXPECT_EQ(scene.files, (std::vector<std::string>{"test.argos", "parts/block.argos"}));
}

TEST(Models, GiveTheSameEntityAsTheWrittenOutText) {
  const std::string parts =
      R"(<links ref="l"><link id="l" geometry="box" size="1,2,3" mass="4" friction="0.1"/></links>)"
      R"(<devices><tags medium="tags"><tag anchor="l" position="1,1,1" orientation="1,2,3" )"
      R"(observable_angle="40" side_length="0.2" payload="p"/></tags></devices>)";
  const ReadResult result =
      using_block(R"(<prototype id="a" model="m"><body position="0,0,1"/></prototype>)"
                  R"(<prototype id="b"><body position="0,0,1"/>)" +
                      parts + "</prototype>",
                  "<models><prototype id=\"m\">" + parts + "</prototype></models>")
          .read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  const Entity &a = result.scene.entities[0], &b = result.scene.entities[1];
  EXPECT_EQ(std::get<Box>(a.links[0].geometry).size, std::get<Box>(b.links[0].geometry).size);
  EXPECT_EQ(a.links[0].mass, b.links[0].mass);
  EXPECT_EQ(a.links[0].surface.friction, b.links[0].surface.friction);
  EXPECT_EQ(a.links[0].damping.linear, b.links[0].damping.linear);
  EXPECT_EQ(a.devices.tag_medium, b.devices.tag_medium);
  EXPECT_EQ(a.devices.tags[0].payload, b.devices.tags[0].payload);
  EXPECT_EQ(a.devices.tags[0].pose.orientation.coeffs(),
            b.devices.tags[0].pose.orientation.coeffs());
  EXPECT_EQ(a.pose.position, b.pose.position);
  EXPECT_FALSE(b.model);
}

TEST(Models, AnEntitysControllerReplacesTheModels) {
  const ReadResult result = read_block(
      R"(<prototype id="a" model="block"><body/></prototype>)"
      R"(<prototype id="b" model="block"><body/><controller config="other"/></prototype>)"
      R"(<prototype id="c" model="block"><body/><controller config="blink"><params x="1"/></controller></prototype>)");
  ASSERT_TRUE(result.ok()) << all_problems(result);
  const Scene& scene = result.scene;
  ASSERT_EQ(scene.controllers.size(), 2u);
  EXPECT_EQ(scene.controllers[0].id, "other") << "the scene's own come first";
  EXPECT_EQ(scene.controllers[1].id, "blink");
  EXPECT_EQ(scene.controllers[1].params_where.file, 1u);
  const Entity &a = scene.entities[0], &b = scene.entities[1], &c = scene.entities[2];
  using Params = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(a.controller, 1u);
  EXPECT_TRUE(a.overrides_params);
  EXPECT_EQ(a.params, (Params{{"script", "own.lua"}}));
  EXPECT_EQ(a.params_where.file, 1u);
  EXPECT_EQ(a.params_where.line, 15u);
  EXPECT_EQ(b.controller, 0u);
  EXPECT_FALSE(b.overrides_params) << "the model's <params> belong to the model's controller";
  EXPECT_TRUE(b.params.empty());
  EXPECT_EQ(c.controller, 1u);
  EXPECT_EQ(c.params, (Params{{"x", "1"}}));
  EXPECT_EQ(c.params_where.file, 0u);
}

TEST(Models, MovableCanBeOverridden) {
  const std::string models =
      R"(<models><box id="crate" size="1,1,1" movable="true" mass="3"/>)"
      R"(<cylinder id="post" radius="1" height="2" movable="false"/></models>)";
  const ReadResult result = using_block(R"(<box id="a" model="crate"><body/></box>)"
                                        R"(<box id="b" model="crate" movable="false"><body/></box>)"
                                        R"(<cylinder id="c" model="post"><body/></cylinder>)",
                                        models)
                                .read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  EXPECT_TRUE(result.scene.entities[0].movable);
  EXPECT_EQ(result.scene.entities[0].links[0].mass, 3.0);
  EXPECT_FALSE(result.scene.entities[1].movable);
  EXPECT_EQ(result.scene.entities[1].links[0].mass, 0.0);
  EXPECT_FALSE(result.scene.entities[2].movable);
  const auto wrong = faults(
      using_block("<cylinder id=\"c\" model=\"post\" movable=\"true\"><body/></cylinder>", models)
          .read());
  ASSERT_EQ(wrong.size(), 1u);
  EXPECT_EQ(wrong[0].find("test.argos:5:40: movable=\"true\" of <cylinder> needs a mass"), 0u)
      << wrong[0];
}

TEST(Models, FootBotAndEPuckCanBeModels) {
  const std::string rest =
      R"(<models><foot-bot id="rover" rab_range="2"><controller config="driver"/></foot-bot></models>)";
  SceneText text = using_block(
      R"(<foot-bot id="a" model="rover"><body position="1,2,0"/></foot-bot>)"
      R"(<foot-bot id="b" model="rover" movable="false"><body/><controller config="other"/></foot-bot>)",
      rest);
  text.media = R"(<media><led id="leds"/><led id="lamps"/><range_and_bearing id="rab"/></media>)";
  text.controllers =
      R"(<controllers><external_controller id="other"><actuators/><sensors/></external_controller>)"
      R"(<external_controller id="driver"><actuators><leds implementation="default" medium="lamps"/>)"
      R"(<differential_steering implementation="default"/></actuators><sensors/>)"
      R"(</external_controller></controllers>)";
  const ReadResult result = text.read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  const Scene& scene = result.scene;
  ASSERT_EQ(scene.entities.size(), 2u);
  for (const Entity& robot : scene.entities) {
    EXPECT_EQ(robot.kind, EntityKind::foot_bot);
    EXPECT_EQ(robot.model, 0u);
    EXPECT_EQ(robot.links.at(0).mass, 1.6) << "a robot that stands still keeps its mass";
    EXPECT_EQ(robot.turret, 1u);
    EXPECT_EQ(robot.devices.leds.size(), 13u);
    EXPECT_EQ(robot.devices.range_and_bearing->range, 2);
    EXPECT_EQ(robot.devices.range_and_bearing_medium, 2u);
  }
  const Entity &a = scene.entities[0], &b = scene.entities[1];
  EXPECT_TRUE(a.movable);
  EXPECT_EQ(a.pose.position, math::Vector3(1, 2, 0));
  ASSERT_EQ(a.controller, 1u);
  EXPECT_EQ(scene.controllers[1].devices.leds->medium, 1u);
  EXPECT_FALSE(b.movable);
  EXPECT_EQ(b.controller, 0u);
  text.arena = R"(<arena size="2,2,2"><foot-bot id="a" model="rover"><body/></foot-bot></arena>)";
  text.rest = R"(<models><foot-bot id="rover"/></models>)";
  EXPECT_EQ(count_containing(faults(text.read()), "<foot-bot> lacks the element <controller>"), 1u)
      << "neither the model nor the entity has one";
}

TEST(Models, CanBeDistributed) {
  const ReadResult result = read_block(
      R"(<distribute><position method="uniform" min="0,0,0" max="9,9,9"/>)"
      R"(<orientation method="constant" values="0,0,0"/>)"
      R"(<entity quantity="40" max_trials="10"><prototype id="b" model="block"/></entity></distribute>)");
  ASSERT_TRUE(result.ok()) << all_problems(result);
  ASSERT_EQ(result.scene.distributions.size(), 1u);
  const Distribution& group = result.scene.distributions[0];
  EXPECT_EQ(group.quantity, 40u);
  EXPECT_EQ(group.entity.id, "b");
  EXPECT_EQ(group.entity.model, 0u);
  EXPECT_EQ(group.entity.links.size(), 2u);
  EXPECT_EQ(group.entity.controller, 1u);
}

TEST(Models, FortyBlocksAreReadAtOnce) {
  std::string devices, elements;
  for (int i = 0; i < 24; ++i) {
    devices += R"(<directional_led anchor="core" position="0.1,0.2,0.3" orientation="0,90,0" )"
               R"(observable_angle="75" color="black"/>)";
  }
  for (int i = 0; i < 40; ++i) {
    elements += "<prototype id=\"b" + std::to_string(i) + R"(" model="b"><body position="0,0,)" +
                std::to_string(i) + "\"/></prototype>\n";
  }
  SceneText text =
      using_block(elements,
                  "<models><prototype id=\"b\"><links ref=\"core\"><link id=\"core\" "
                  "geometry=\"box\" size=\"1,1,1\" mass=\"1\"/></links><devices><directional_leds "
                  "medium=\"dirs\">" +
                      devices + "</directional_leds></devices></prototype></models>");
  text.media = "<media><directional_led id=\"dirs\"/></media>";
  double least = 1e9;  // [s] of several: the first one fills the caches
  for (int i = 0; i < 5; ++i) {
    const std::clock_t start = std::clock();  // processor time: the machine may be busy
    const ReadResult result = text.read();
    least = std::min(least, double(std::clock() - start) / CLOCKS_PER_SEC);
    ASSERT_TRUE(result.ok()) << all_problems(result);
    ASSERT_EQ(result.scene.entities[39].devices.directional_leds.size(), 24u);
  }
  RecordProperty("milliseconds", std::to_string(least * 1e3));
  EXPECT_LT(least, 0.05);
}

/// The blocks of XML in the section `Models` of docs/scene-format.md.
std::vector<std::string> documented_files() {
  std::ifstream file(checkout() / "docs/scene-format.md");
  const std::string text(std::istreambuf_iterator<char>(file), {});
  std::vector<std::string> blocks;
  const std::size_t end = text.find("\n### ", text.find("\n### Models") + 1);
  for (std::size_t at = text.find("\n### Models"); (at = text.find("```xml\n", at)) < end;) {
    at += 7;
    blocks.push_back(text.substr(at, text.find("```", at) - at));
  }
  return blocks;
}

TEST(Models, TheDocumentedExampleIsValid) {
  const auto blocks = documented_files();
  ASSERT_EQ(blocks.size(), 2u);
  const ReadResult result =
      read_text(blocks[1], "scene.argos", options_with({{"models/block.argos", blocks[0]}}));
  EXPECT_TRUE(result.problems.empty()) << all_problems(result);
  ASSERT_EQ(result.scene.models.size(), 2u);
  ASSERT_EQ(result.scene.entities.size(), 3u);
  EXPECT_EQ(result.scene.controllers.at(*result.scene.entities[1].controller).id, "block");
  EXPECT_EQ(result.scene.controllers.at(*result.scene.entities[2].controller).id, "mine");
  ASSERT_EQ(result.scene.distributions.size(), 1u);
  EXPECT_EQ(result.scene.distributions[0].quantity, 40u);
}

}  // namespace
}  // namespace ziggurat::scene
