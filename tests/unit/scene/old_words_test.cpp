// SPDX-License-Identifier: MIT
// Words of other versions of the dialect: notices, each with what it means here.

#include <gtest/gtest.h>

#include <string>

#include "scene_text.h"

namespace ziggurat::scene {
namespace {

SceneText with_sensor(const std::string& sensor) {
  SceneText text;
  text.controllers = "<controllers><lua_controller id=\"c\"><actuators/><sensors>" + sensor +
                     "</sensors><params/></lua_controller></controllers>";
  text.media = R"(<media><range_and_bearing id="rab" index="dummy"/><led id="leds"/></media>)";
  return text;
}

/// The scene can be read, and has exactly one notice with this part.
Scene read_with_notice(const SceneText& text, const std::string& part,
                       const ReadOptions& options = {}) {
  ReadResult result = text.read(options);
  EXPECT_TRUE(result.ok()) << all_problems(result);
  EXPECT_EQ(count_containing(notices(result), part), 1u) << "expected: " << part << "\n"
                                                         << all_problems(result);
  return std::move(result.scene);
}

TEST(OldWords, WithoutEffectAreNotices) {
  SceneText text;
  text.arena = R"(<arena size="2,2,2" positional_index="grid" positional_grid_size="1,1,1"/>)";
  read_with_notice(
      text,
      "4:21: positional_index of <arena> has no effect here: bodies are found by their place");
  read_with_notice(text, "4:45: positional_grid_size of <arena> has no effect here");
  text = {};
  text.engines =
      R"(<physics_engines><dynamics3d id="d" debug_file="x" solver="newton" solver_iterations="9"><virtual_magnetism k="1"/><srocs/>)"
      R"(</dynamics3d></physics_engines>)";
  read_with_notice(text, "debug_file of <dynamics3d> has no effect here: record the run instead");
  read_with_notice(text, "solver of <dynamics3d> has no effect here: there is one solver");
  read_with_notice(text,
                   "solver_iterations of <dynamics3d> has no effect here: there is one solver");
  read_with_notice(text,
                   "<virtual_magnetism> in <dynamics3d> has no effect here: write <magnetism/>");
  read_with_notice(text, "<srocs> in <dynamics3d> has no effect here: write <magnetism/>");
}

TEST(OldWords, FrictionOfCylindersOnDynamics2dHasNoEffect) {
  SceneText text;
  text.engines =
      R"(<physics_engines><dynamics2d id="d" cylinder_linear_friction="2" cylinder_angular_friction="3"/>)"
      R"(</physics_engines>)";
  const Scene scene = read_with_notice(
      text, "cylinder_linear_friction of <dynamics2d> has no effect here: write it on <friction>");
  read_with_notice(text, "cylinder_angular_friction of <dynamics2d> has no effect here");
  EXPECT_EQ(scene.physics.planes.at(0).cylinder.max_force, 1.49);
}

TEST(OldWords, NoiseLevelIsToldItsOtherNames) {
  read_with_notice(
      with_sensor(R"(<range_and_bearing implementation="medium" medium="rab" noise_level="1"/>)"),
      "noise_level of <range_and_bearing> has no effect here: write noise_std_dev");
  read_with_notice(
      with_sensor(R"(<positioning implementation="default" noise_level="1" show_rays="true"/>)"),
      "noise_level of <positioning> has no effect here: write pos_noise_range");
  read_with_notice(
      with_sensor(R"(<differential_steering implementation="default" noise_level="1"/>)"),
      "noise_level of <differential_steering> has no effect here: write vel_noise_range");
}

TEST(OldWords, AreReadAsTheirNewNames) {
  SceneText text;
  text.engines =
      R"(<physics_engines><dynamics3d id="d" default_friction="0.7"/></physics_engines>)";
  text.arena = arena_with(R"(<box id="b" size="1,1,1" movable="false"><body/></box>)");
  Scene scene = read_with_notice(text, "default_friction of <dynamics3d> is read as friction");
  EXPECT_EQ(scene.entities.at(0).links.at(0).surface.friction, 0.7);

  text = {};
  text.media = R"(<media><simple_radio id="r"/></media>)";
  text.arena = arena_with(
      R"(<prototype id="p"><body/><links ref="l"><link id="l" geometry="sphere" radius="1" mass="1"/></links>)"
      R"(<devices><simple_radios><radio anchor="l" position="0,0,0" range="1" medium="r"/></simple_radios></devices>)"
      R"(</prototype>)");
  scene = read_with_notice(text, "<simple_radio> in <media> is read as <radio>");
  read_with_notice(text, "<simple_radios> in <devices> is read as <radios>");
  EXPECT_EQ(scene.media.at(0).kind, MediumKind::radio);
  EXPECT_EQ(scene.entities.at(0).devices.radio_medium, 0u);

  scene = read_with_notice(
      with_sensor(
          R"(<range_and_bearing implementation="medium" medium="rab" loss_probability="0.25"/>)"),
      "loss_probability of <range_and_bearing> is read as packet_drop_prob");
  EXPECT_EQ(scene.controllers.at(0).devices.range_and_bearing->loss, 0.25);
  read_with_notice(with_sensor(""), R"(index="dummy" of <range_and_bearing> is read as "grid")");
}

TEST(OldWords, AWrongValueIsAFaultWithTheWordAsWritten) {
  SceneText text;
  text.engines = R"(<physics_engines><dynamics3d id="d" default_friction="-1"/></physics_engines>)";
  const auto texts = faults(text.read());
  ASSERT_EQ(texts.size(), 1u);
  EXPECT_NE(texts[0].find("5:55: default_friction=\"-1\" of <dynamics3d> is negative"),
            std::string::npos)
      << texts[0];
}

TEST(OldWords, BesideTheNewNameHaveNoEffect) {
  SceneText text;
  text.engines =
      R"(<physics_engines><dynamics3d id="d" default_friction="1" friction="0.5"/></physics_engines>)";
  text.arena = arena_with(R"(<box id="b" size="1,1,1" movable="false"><body/></box>)");
  const Scene scene =
      read_with_notice(text, "default_friction of <dynamics3d> has no effect beside friction");
  EXPECT_EQ(scene.entities.at(0).links.at(0).surface.friction, 0.5);
}

std::string hull_link(const std::string& points) {
  return R"(<prototype id="p"><body/><links ref="l"><link id="l" geometry="convex_hull" mass="1">)" +
         points + "</link></links></prototype>";
}

TEST(OldWords, ConvexHullIsHull) {
  SceneText text;
  for (const char* points :
       {"<hull><vertex position=\"0,0,0\"/><vertex position=\"1,0,0\"/><vertex position=\"0,1,0\"/>"
        "<vertex position=\"0,0,1\"/></hull>",
        "\n(0,0,0) (1, 0,0)(0,1,0)\n(0,0,1) "}) {
    text.arena = arena_with(hull_link(points));
    const Scene scene =
        read_with_notice(text, R"(geometry="convex_hull" of <link> is read as "hull")");
    const auto& hull = std::get<Hull>(scene.entities.at(0).links.at(0).geometry);
    EXPECT_EQ(hull.polyhedron->vertices.size(), 4u);
    EXPECT_EQ(bounds(hull).high, math::Vector3::Ones());
  }
  for (const char* points : {"(0,0,0)(1,0,0", "(0,0)", "points"}) {
    text.arena = arena_with(hull_link(points));
    EXPECT_EQ(count_containing(faults(text.read()), "<link> has the text"), 1u)
        << all_problems(text.read());
  }
}

TEST(OldWords, PointsOfAHullAreElements) {
  SceneText text;
  const std::string points =
      R"(<point position="0,0,0"/><point position="1,0,0"/><point position="0,1,0"/>)"
      R"(<point position="0,0,1"/>)";
  for (const std::string& parts : {points, "<points>" + points + "</points>"}) {
    for (const char* word : {"convexhull", "convex_hull"}) {
      std::string link = hull_link(parts);
      link.replace(link.find("convex_hull"), 11, word);
      text.arena = arena_with(link);
      const Scene scene = read_with_notice(text, R"(of <link> is read as "hull")");
      const auto& hull = std::get<Hull>(scene.entities.at(0).links.at(0).geometry);
      EXPECT_EQ(hull.polyhedron->vertices.size(), 4u);
    }
  }
  text.arena = arena_with(hull_link(R"(<point position="0,0,0"/><point at="1,0,0"/>)"));
  EXPECT_GE(count_containing(faults(text.read()), "<point> lacks the attribute position"), 1u);
}

TEST(OldWords, BatteriesOfLaterVersionsLoseTheSame) {
  SceneText text = with_sensor(R"(<battery implementation="default"/>)");
  text.arena = arena_with(
      R"(<foot-bot id="f"><body/><battery model="time_motion" delta="1" pos_delta="2" orient_delta="3"/>)"
      R"(<controller config="c"/></foot-bot>)");
  const Scene scene = read_with_notice(text, ": delta of <battery> is read as factor");
  const Battery& battery = *scene.entities.at(0).devices.battery;
  EXPECT_EQ(battery.per_tick, 1);
  EXPECT_EQ(battery.per_metre, 2);
  EXPECT_EQ(battery.per_radian, 3);
}

TEST(OldWords, AMassThatNothingMovesIsOfABodyThatStays) {
  SceneText text;
  text.arena = arena_with(
      R"(<cylinder id="c" radius="1" height="1" movable="true" mass="5e12"><body/></cylinder>)");
  const Scene scene = read_with_notice(
      text,
      "4:96: a mass of 5e+12 kg is one that nothing moves, and is read as movable=\"false\"; "
      "write that instead of it");
  EXPECT_FALSE(scene.entities.at(0).movable);
  text.arena = arena_with(
      R"(<prototype id="p"><body/><links ref="l"><link id="l" geometry="sphere" radius="1" mass="5e12"/>)"
      R"(</links></prototype>)");
  EXPECT_FALSE(read_with_notice(text, "a mass of 5e+12 kg").entities.at(0).movable);
  text.arena =
      arena_with(R"(<sphere id="s" radius="1" movable="true" mass="1e9"><body/></sphere>)");
  const ReadResult result = text.read();
  EXPECT_TRUE(result.problems.empty()) << all_problems(result);
  EXPECT_EQ(result.scene.entities.at(0).links.at(0).mass, 1e9);
}

TEST(OldWords, AnArenaOfHeight0IsFlat) {
  SceneText text;
  text.arena = R"(<arena size="2, 3, 0"/>)";
  const Scene scene =
      read_with_notice(text, "4:14: an <arena> of height 0 is a flat world, without a ceiling");
  EXPECT_EQ(scene.arena.size, math::Vector3(2, 3, 0));
  for (const char* wrong : {"2,0,0", "0,2,0", "2,0", "0", "2,2,2,0", "2,2,-0.5"}) {
    text.arena = std::string("<arena size=\"") + wrong + "\"/>";
    EXPECT_EQ(faults(text.read()).size(), 1u) << wrong;
  }
}

TEST(OldWords, CopiesWithoutANameAreNumberedAlone) {
  const auto group = [](const std::string& id) {
    return R"(<distribute><position method="constant" values="0,0,0"/><orientation method="constant" )"
           R"(values="0,0,0"/><entity quantity="2" max_trials="1"><box id=")" +
           id + R"(" size="1,1,1" movable="false"/></entity></distribute>)";
  };
  SceneText text;
  text.arena = arena_with(group(""));
  const ReadResult result = text.read();
  EXPECT_TRUE(result.ok()) << all_problems(result);
  EXPECT_EQ(result.scene.distributions.at(0).entity.id, "");
  text.arena = arena_with(group("") + "\n" + group(""));
  const auto texts = faults(text.read());
  ASSERT_EQ(texts.size(), 1u);
  EXPECT_NE(texts[0].find("makes a copy called \"0\", which is the id of another entity"),
            std::string::npos)
      << texts[0];
  text.arena = arena_with(R"(<box id="" size="1,1,1" movable="false"><body/></box>)");
  EXPECT_EQ(count_containing(faults(text.read()), "id=\"\" of <box> is empty"), 1u);
}

TEST(OldWords, LenientRunsWhatLibrariesBelongTo) {
  SceneText text;
  text.arena = arena_with(R"(<floor id="f" source="loop_functions" pixels_per_meter="50"/>)");
  text.rest =
      R"(<loop_functions library="build/x" label="x"><items radius="0.1"/></loop_functions>)";
  const ReadResult strict = text.read();
  EXPECT_EQ(count_containing(faults(strict), "--lenient"), 1u) << all_problems(strict);
  EXPECT_EQ(faults(strict).size(), 1u) << all_problems(strict);
  read_with_notice(text, "<floor source=\"loop_functions\"> is white", {.lenient = true});
  const Scene scene = read_with_notice(
      text, "<loop_functions> has no effect: libraries are not loaded", {.lenient = true});
  EXPECT_TRUE(scene.directors.empty());
}

}  // namespace
}  // namespace ziggurat::scene
