// SPDX-License-Identifier: MIT
// Framework, engines and media: their values, and notices about parts without effect.

#include <gtest/gtest.h>

#include <optional>
#include <utility>

#include "scene_text.h"

namespace ziggurat::scene {
namespace {

TEST(Framework, DefaultsAndValues) {
  SceneText text;
  EXPECT_EQ(text.read().scene.experiment.length, 0.0);
  text.framework =
      R"(<framework><experiment ticks_per_second=" 5 " length="8.4" random_seed="124" real_time="true"/></framework>)";
  const ReadResult result = text.read();
  ASSERT_TRUE(result.problems.empty()) << all_problems(result);
  const Experiment& experiment = result.scene.experiment;
  EXPECT_EQ(experiment.ticks_per_second, 5u);
  EXPECT_EQ(experiment.length, 8.4);
  EXPECT_EQ(experiment.random_seed, 124u);
  EXPECT_TRUE(experiment.real_time);
}

TEST(Framework, PartsWithoutEffectGiveNotices) {
  SceneText text;
  text.framework =
      R"(<framework><system threads="4" method="balance_length"/><experiment ticks_per_second="1"/>)"
      R"(<profiling file="p" format="table"/></framework>)";
  text.rest = "<visualization><qt-opengl anything=\"at all\"/></visualization>\n";
  const ReadResult result = text.read();
  EXPECT_TRUE(result.ok()) << all_problems(result);
  EXPECT_EQ(count_containing(notices(result), "method of <system> has no effect"), 1u);
  EXPECT_EQ(count_containing(notices(result), "<profiling> has no effect"), 1u);
  EXPECT_EQ(count_containing(notices(result), "7:1: <visualization> has no effect"), 1u);
}

TEST(Framework, ThreadsOfSystemAreTheRunsUnlessItHasItsOwn) {
  using Options = std::vector<std::pair<std::string, std::string>>;
  const auto run = [](const std::string& parts) {
    SceneText text;
    text.framework = "<framework>" + parts + R"(<experiment ticks_per_second="1"/></framework>)";
    ReadOptions options;
    options.run = {{"threads"}, [](const std::string&, const std::string& value) {
                     return value == "many" ? std::optional<std::string>("is many") : std::nullopt;
                   }};
    const ReadResult result = text.read(options);
    return result.ok() ? result.scene.run : Options{{"fault", faults(result).at(0)}};
  };
  EXPECT_EQ(run(R"(<system threads="4"/>)"), (Options{{"threads", "4"}}));
  EXPECT_EQ(run(R"(<system threads="0"/>)"), Options());
  EXPECT_EQ(run(R"(<system threads="4"/><run threads="2"/>)"), (Options{{"threads", "2"}}));
  EXPECT_NE(
      run(R"(<system threads="many"/>)").at(0).second.find("threads=\"many\" of <system> is many"),
      std::string::npos);
}

TEST(Framework, ALengthBetweenTwoTicksIsTold) {
  SceneText text;
  text.framework = R"(<framework><experiment ticks_per_second="10" length="1.25"/></framework>)";
  EXPECT_EQ(
      count_containing(notices(text.read()),
                       "2:54: length=\"1.25\" of <experiment> is 12.5 ticks of 1/10 s: the run "
                       "has 12, and ends after 1.2 s"),
      1u)
      << all_problems(text.read());
  text.framework = R"(<framework><experiment ticks_per_second="100" length="0.29"/></framework>)";
  EXPECT_TRUE(notices(text.read()).empty());  // 28.999999999999996
}

TEST(Framework, TheFirstOfTwoIsUsed) {
  SceneText text;
  text.rest = R"(<framework><experiment ticks_per_second="77"/></framework>)";
  const ReadResult result = text.read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  EXPECT_EQ(result.scene.experiment.ticks_per_second, 10u);
  EXPECT_EQ(count_containing(notices(result), "a second <framework>"), 1u);
}

TEST(Engines, NegativeGravityIsDoubted) {
  SceneText text;
  text.engines =
      R"(<physics_engines><dynamics3d id="d"><gravity g="-9.8"/></dynamics3d></physics_engines>)";
  const ReadResult result = text.read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  EXPECT_NE(all_problems(result).find("g=\"-9.8\" of <gravity> lets everything fall up"),
            std::string::npos)
      << all_problems(result);
}

TEST(Engines, StrongGravityAndManyIterationsAreDoubted) {
  SceneText text;
  const auto read = [&](const std::string& iterations, const std::string& g) {
    text.engines = "<physics_engines><dynamics3d id=\"d\" iterations=\"" + iterations +
                   "\"><gravity g=\"" + g + "\"/></dynamics3d></physics_engines>";
    const ReadResult result = text.read();
    EXPECT_TRUE(result.ok());
    return all_problems(result);
  };
  EXPECT_NE(read("10", "-1e6").find("g=\"-1e6\" of <gravity> is stronger than 1000 m/s^2"),
            std::string::npos);
  EXPECT_EQ(read("10", "-1e6").find("fall up"), std::string::npos) << "one sentence says it";
  EXPECT_NE(read("10001", "9.8").find("iterations=\"10001\" of <dynamics3d> are so many substeps"),
            std::string::npos);
  EXPECT_EQ(read("10000", "1000"), read("10", "9.8"));
}

TEST(Engines, DefaultsAndValues) {
  SceneText text;
  const ReadResult plain = text.read();
  EXPECT_EQ(plain.scene.physics.iterations, 10u);
  EXPECT_EQ(plain.scene.physics.clock, Clock::nominal);
  EXPECT_FALSE(plain.scene.physics.floor || plain.scene.physics.gravity);
  text.engines =
      R"(<physics_engines><dynamics3d id="d" iterations="25" clock="beta50" max_substep="0.001")"
      R"( friction="0.7" restitution="0.2"><gravity/>)"
      R"(<floor rolling_friction="0.1" spinning_friction="0.01"/>)"
      R"(</dynamics3d></physics_engines>)";
  const ReadResult result = text.read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  const Physics& physics = result.scene.physics;
  EXPECT_EQ(physics.iterations, 25u);
  EXPECT_EQ(physics.clock, Clock::beta50);
  EXPECT_EQ(physics.max_substep, 0.001);
  EXPECT_EQ(physics.floor->surface.restitution, 0.2);
  EXPECT_EQ(physics.floor->surface.spinning_friction, 0.01);
  EXPECT_EQ(physics.gravity, 10.0);
  EXPECT_EQ(physics.floor->surface.friction, 0.7);
  EXPECT_EQ(physics.floor->surface.rolling_friction, 0.1);
}

TEST(Engines, TheClockOfTheCommandLineTakesThePlaceOfTheScenes) {
  SceneText text;
  ReadOptions options;
  text.engines = "<physics_engines><dynamics3d id='d' clock='beta50'/></physics_engines>";
  EXPECT_EQ(text.read(options).scene.physics.clock, Clock::beta50);
  options.clock = Clock::nominal;
  EXPECT_EQ(text.read(options).scene.physics.clock, Clock::nominal);
}

/// Recordings of versions that had a second core can't be repeated.
TEST(Engines, WhatWasMovedByASecondCoreIsKnown) {
  const auto had_second_core = [](const std::string& attributes) {
    SceneText text;
    text.engines = "<physics_engines><dynamics3d id='d' " + attributes + "/></physics_engines>";
    return text.read().scene.physics.had_second_core;
  };
  EXPECT_FALSE(had_second_core(""));
  EXPECT_TRUE(had_second_core("clock='beta50'"));
  EXPECT_TRUE(had_second_core("solver='sweeps'"));
  EXPECT_FALSE(had_second_core("clock='beta50' solver='newton'"));
}

TEST(Engines, TheClockOfTheCommandLineHoldsForFlatWorlds) {
  SceneText text;
  text.engines = R"(<physics_engines><dynamics2d id="flat"/></physics_engines>)";
  EXPECT_EQ(text.read().scene.physics.clock, Clock::nominal);
  ReadOptions options;
  options.clock = Clock::beta50;
  const Physics physics = text.read(options).scene.physics;
  EXPECT_EQ(physics.clock, Clock::beta50);
  EXPECT_TRUE(physics.had_second_core);
}

TEST(Engines, TwoDimensionalEnginesShareTheWorld) {
  SceneText text;
  text.engines =
      R"(<physics_engines><dynamics2d id="flat" elevation="0"><friction box_linear_friction="1"/>)"
      R"(</dynamics2d><dynamics3d id="deep" iterations="3"/></physics_engines>)";
  const ReadResult result = text.read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  EXPECT_EQ(result.scene.physics.id, "deep");
  EXPECT_EQ(result.scene.physics.iterations, 3u);
  EXPECT_EQ(count_containing(notices(result), "<dynamics2d> runs in the same 3D world"), 1u);
}

TEST(Engines, EntitiesNeedAnEngine) {
  SceneText text;
  text.engines = "<physics_engines/>";
  EXPECT_TRUE(text.read().ok());
  text.arena = arena_with(R"(<box id="b" size="1,1,1" movable="false"><body/></box>)");
  EXPECT_EQ(count_containing(faults(text.read()), "<physics_engines> has no engine"), 1u);
}

TEST(Media, KeepDocumentOrder) {
  SceneText text;
  text.media =
      R"(<media><tag id="t" index="grid" grid_size="20,20,20"/><led id="l" grid_size="1,1,1"/>)"
      R"(<led id="m"/><range_and_bearing id="r" check_occlusions="false"/></media>)";
  const ReadResult result = text.read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  ASSERT_EQ(result.scene.media.size(), 4u);
  EXPECT_EQ(result.scene.media[0].kind, MediumKind::tag);
  EXPECT_EQ(result.scene.media[2].id, "m");
  EXPECT_TRUE(result.scene.media[0].checks_occlusions);
  EXPECT_FALSE(result.scene.media[3].checks_occlusions);
  EXPECT_EQ(count_containing(notices(result), "grid_size of <led> has no effect"), 1u);
}

TEST(Media, PacketsOfRangeAndBearingHaveALimitedSize) {
  SceneText text;
  text.media = R"(<media><range_and_bearing id="r"/></media>)";
  text.arena =
      R"(<arena size="2,2,2"><prototype id="p"><body/><links ref="l"><link id="l" mass="1" )"
      R"(geometry="sphere" radius="1"/></links><devices><range_and_bearing medium="r" anchor="l" )"
      R"(data_size="65537"/></devices></prototype></arena>)";
  EXPECT_EQ(count_containing(faults(text.read()), "write a whole number from 0 to 65536"), 1u);
}

}  // namespace
}  // namespace ziggurat::scene
