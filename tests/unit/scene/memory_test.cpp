// SPDX-License-Identifier: MIT
// Scenes that would take too much memory are refused while they are read, at the element that is
// one too many.

#include <gtest/gtest.h>

#include <string>

#include "scene_text.h"

namespace ziggurat::scene {
namespace {

std::string repeated(int count, const std::string& text) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

std::string numbered(int count, const std::string& before, const std::string& after) {
  std::string all;
  for (int i = 0; i < count; ++i) all += before + std::to_string(i) + after;
  return all;
}

std::string distributed(unsigned quantity, const std::string& entity) {
  return "<distribute><position method='constant' values='0,0,0'/><orientation method='constant' "
         "values='0,0,0'/>"
         "<entity quantity='" +
         std::to_string(quantity) + "' max_trials='1'>" + entity + "</entity></distribute>";
}

std::string prototype_of(const std::string& id, const std::string& links,
                         const std::string& devices = "") {
  return "<prototype id='" + id + "'><body position='0,0,0'/><links ref='l0'>" + links +
         "</links><devices>" + devices + "</devices></prototype>";
}

const std::string link_of_prototype = "<link id='l0' geometry='sphere' radius='1' mass='1'/>";

SceneText scene_with(const std::string& elements) {
  SceneText text;
  text.media = "<media><led id='leds'/><range_and_bearing id='rab'/></media>";
  text.arena = arena_with(elements);
  return text;
}

std::string only_fault(const SceneText& text, const ReadOptions& options = {}) {
  const auto found = faults(text.read(options));
  EXPECT_EQ(found.size(), 1u);
  return found.empty() ? "" : found.front();
}

void expect_good(const SceneText& text) {
  const ReadResult result = text.read();
  EXPECT_TRUE(result.ok()) << all_problems(result).substr(0, 1000);
}

TEST(Memory, LargeScenesHaveEnough) {
  const std::string box = "<box id='b' size='.1,.1,.1' movable='true' mass='1'/>";
  expect_good(scene_with(distributed(40'000, box)));
  expect_good(scene_with(distributed(1'000'000, box)));
  expect_good(scene_with(numbered(100'000, "<box id='",
                                  "' size='.1,.1,.1' movable='true' mass='1'><body "
                                  "position='0,0,0'/></box>")));
  SceneText robots =
      scene_with(distributed(4096, "<foot-bot id='f'><controller config='c'/></foot-bot>") +
                 distributed(4096, "<e-puck id='e'><controller config='c'/></e-puck>"));
  robots.controllers =
      "<controllers><lua_controller id='c'><actuators/><sensors><cameras implementation='default'>"
      "<camera id='eye' anchor='base' position='0,0,0' orientation='0,0,0' range='0.1:1' "
      "focal_length='1,1' "
      "principal_point='1,1' resolution='320,240' image='true'/></cameras></sensors><params "
      "script='x.lua'" +
      numbered(50, " parameter", "='a usual value of twenty bytes or so'") +
      "/></lua_controller></controllers>";
  expect_good(robots);
}

TEST(Memory, CopiesOfADistributionCount) {
  const std::string leds = "<leds medium='leds'>" +
                           repeated(3000, "<led anchor='origin' offset='0,0,0' color='red'/>") +
                           "</leds>";
  const SceneText text =
      scene_with("\n" + distributed(100'000, prototype_of("p", link_of_prototype, leds)));
  EXPECT_EQ(only_fault(text),
            "test.argos:5:122: quantity=\"100000\" of <entity> is too many: each of these entities "
            "takes some 1.1 MB of memory, "
            "and the scene has 4285.5 MB left; write at most 3741, or raise --max-scene-size");
  EXPECT_TRUE(
      scene_with(distributed(3741, prototype_of("p", link_of_prototype, leds))).read().ok());
  ReadOptions larger;
  larger.max_size = std::size_t{4} << 30;
  EXPECT_TRUE(text.read(larger).ok());
}

TEST(Memory, LinksOfCopiesCount) {
  const auto joint =
      "<joint type='fixed'><parent link='l0' position='0,0,0' orientation='0,0,0'/><child "
      "position='0,0,0' "
      "orientation='0,0,0' link='l";
  std::string links, joints;
  for (int i = 0; i < 60; ++i) {
    links += "<link id='l" + std::to_string(i) + "' geometry='sphere' radius='1' mass='1'/>";
    if (i > 0) joints += joint + std::to_string(i) + "'/></joint>";
  }
  const std::string chain = "<prototype id='p'><links ref='l0'>" + links + "</links><joints>" +
                            joints + "</joints></prototype>";
  EXPECT_NE(only_fault(scene_with(distributed(100'000, chain)))
                .find("is too many: each of these entities takes some 0.2 MB"),
            std::string::npos);
}

TEST(Memory, LongChainsCountWithTheSquareOfTheirLength) {
  const auto chain = [](int count) {
    std::string links = link_of_prototype, joints;
    for (int i = 1; i < count; ++i) {
      const std::string n = std::to_string(i);
      links += "<link id='l" + n + "' geometry='sphere' radius='1' mass='1'/>";
      joints += "<joint type='spherical'><parent link='l" + std::to_string(i - 1) +
                "' position='0,0,0' orientation='0,0,0'/>"
                "<child position='0,0,0' orientation='0,0,0' link='l" +
                n + "'/></joint>";
    }
    return scene_with("<prototype id='p'><body position='0,0,0'/><links ref='l0'>" + links +
                      "</links><joints>" + joints + "</joints></prototype>");
  };
  expect_good(chain(10'000));
  EXPECT_NE(only_fault(chain(30'000)).find("<prototype> takes some 9079.7 MB of memory"),
            std::string::npos)
      << only_fault(chain(30'000));
}

TEST(Memory, ParametersOfRobotsCountForEach) {
  SceneText text =
      scene_with(distributed(5000, "<e-puck id='e'><controller config='c'/></e-puck>"));
  text.controllers =
      "<controllers><lua_controller id='c'><actuators/><sensors/><params script='x.lua' large='" +
      std::string(1'000'000, 'x') + "'/></lua_controller></controllers>";
  EXPECT_NE(
      only_fault(text).find(
          "quantity=\"5000\" of <entity> is too many: each of these entities takes some 4.0 MB"),
      std::string::npos);
  text.arena = arena_with(numbered(5000, "<e-puck id='",
                                   "'><body position='0,0,0'/><controller config='c'/></e-puck>"));
  EXPECT_NE(
      only_fault(text).find(
          "<e-puck> takes some 4.0 MB of memory, with what its model and its controller have"),
      std::string::npos);
}

TEST(Memory, ParametersOfTheSceneCountForEachController) {
  SceneText text;
  text.rest = "<parameters" + numbered(10'000, " a", "='1'") + "/>\n";
  text.controllers =
      "<controllers>" + numbered(10'000, "<external_controller id='", "'/>") + "</controllers>";
  EXPECT_NE(only_fault(text).find("<external_controller> takes some 2.2 MB of memory"),
            std::string::npos)
      << only_fault(text);
}

TEST(Memory, DevicesOfAControllerCountForEachRobot) {
  SceneText text =
      scene_with(distributed(1000, "<e-puck id='e'><controller config='c'/></e-puck>"));
  text.controllers =
      "<controllers><external_controller id='c'><actuators/><sensors><imus "
      "implementation='default'>" +
      numbered(100'000, "<imu anchor='base' id='", "'/>") +
      "</imus></sensors></external_controller></controllers>";
  EXPECT_NE(only_fault(text).find("is too many: each of these entities takes some 52"),
            std::string::npos);
  text.controllers =
      "<controllers><external_controller id='c'><actuators/><sensors><cameras "
      "implementation='default'>"
      "<camera id='eye' anchor='base' position='0,0,0' orientation='0,0,0' range='0.1:1' "
      "focal_length='1,1' "
      "principal_point='1,1' resolution='4096,4096' "
      "image='true'/></cameras></sensors></external_controller>"
      "</controllers>";
  EXPECT_NE(only_fault(text).find("is too many: each of these entities takes some 50.4 MB"),
            std::string::npos);
}

TEST(Memory, RingsCountAsTheirSensors) {
  const std::string rings =
      "<proximity_sensors>" +
      repeated(10, "<ring anchor='origin' radius='.1' range='.1' num_sensors='1000'/>") +
      "</proximity_sensors>";
  std::string prototypes;
  for (int i = 0; i < 3000; ++i)
    prototypes += prototype_of("p" + std::to_string(i), link_of_prototype, rings);
  EXPECT_NE(only_fault(scene_with(prototypes)).find("<prototype> takes some 2.5 MB of memory"),
            std::string::npos);
  SceneText models;
  for (int i = 0; i < 3000; ++i) {
    models.rest += "<prototype id='" + std::to_string(i) + "'><links ref='l0'>" +
                   link_of_prototype + "</links><devices>" + rings + "</devices></prototype>";
  }
  models.rest = "<models>" + models.rest + "</models>\n";
  EXPECT_NE(only_fault(models).find("<prototype> takes some 2.5 MB of memory"), std::string::npos);
}

TEST(Memory, TextsWithParametersCountAsWrittenOut) {
  SceneText text;
  text.rest = "<parameters p='" + std::string(100'000, 'x') + "'/>\n";
  text.controllers = "<controllers><external_controller id='c'><params" +
                     numbered(2000, " a", "='${p}'") + "/></external_controller></controllers>";
  const auto found = faults(text.read());
  ASSERT_GT(found.size(), 100u);
  EXPECT_NE(found[0].find("makes the scene too large, with its parameters written out"),
            std::string::npos)
      << found[0].substr(0, 500);
}

TEST(Memory, SettingsCountForEachAttributeThatTheySet) {
  ReadOptions options;
  options.variation.settings.push_back({"//box/@id", std::string(100'000, 'x')});
  const SceneText text = scene_with(numbered(1000, "<box id='",
                                             "' size='.1,.1,.1' movable='true' mass='1'><body "
                                             "position='0,0,0'/></box>"));
  EXPECT_NE(only_fault(text, options)
                .find("matches 1000 attributes, with whose values the scene is too large"),
            std::string::npos);
  options.variation.settings.assign(257, {"arena/@size", "1,1,1"});
  EXPECT_NE(only_fault(text, options).find("--set is given 257 times; at most 256 are allowed"),
            std::string::npos);
}

TEST(Memory, OfASpawnedEntityCounts) {
  SceneText text = scene_with("");
  text.controllers =
      "<controllers><external_controller id='c'><actuators/><sensors/><params large='" +
      std::string(1'000'000, 'x') + "'/></external_controller></controllers>";
  const ReadResult scene = text.read();
  ASSERT_TRUE(scene.ok());
  const auto read = [&](std::size_t left) {
    return scene.additions.read(
        "<e-puck id='e'><body position='0,0,0'/><controller config='c'/></e-puck>", scene.scene,
        left, [](const std::string&) { return false; });
  };
  const Addition addition = read(1 << 20);
  EXPECT_TRUE(addition.ok());
  EXPECT_GT(addition.size, 60'000u) << "a 64th of its memory";
  EXPECT_FALSE(read(10'000).ok());
}

}  // namespace
}  // namespace ziggurat::scene
