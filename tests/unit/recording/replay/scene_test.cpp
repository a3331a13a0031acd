// SPDX-License-Identifier: MIT
#include "recording/replay/scene.h"

#include <gtest/gtest.h>

#include "checkout/checkout.h"
#include "recorded_run.h"
#include "recording/replay/recording_file.h"
#include "scene/reader.h"
#include "words_of.h"

namespace ziggurat::replay {
namespace {

using testing::files;
using testing::start;

TEST(EmbeddedScene, IsReadWithItsIncludes) {
  const EmbeddedFiles embedded = files();
  const scene::OpenScene opened = read_scene(start(), embedded);
  EXPECT_EQ(opened.scene.files.size(), 2u);
  EXPECT_EQ(opened.scene.entities.size(), 3u);
}

TEST(EmbeddedScene, ReadsNothingFromTheDisk) {
  EmbeddedFiles embedded;
  v1::RunStart run = start();
  run.set_scene((checkout() / "scenes/dynamics3d_single_body_test.argos").string());  // exists
  EXPECT_THROW(read_scene(run, embedded), scene::SceneError);
  embedded.add("scene.argos", R"(<argos><include file="/etc/hostname"/></argos>)");
  run.set_scene("scene.argos");
  EXPECT_TRUE(
      fails_with<scene::SceneError>("is not in the recording", [&] { read_scene(run, embedded); }));
}

TEST(EmbeddedScene, IsFoundByEachWayToWriteItsPath) {
  EmbeddedFiles embedded;
  embedded.add("a/b.xml", "text");
  EXPECT_NE(embedded.find("a/../a/b.xml"), nullptr);
  EXPECT_NE(embedded.find("./a/b.xml"), nullptr);
  EXPECT_EQ(embedded.find("b.xml"), nullptr);
}

TEST(EmbeddedScene, ItsSettingsAreCheckedAsThoseOfOptions) {
  const EmbeddedFiles embedded = files();
  const auto set = [&](const std::string& path) {
    v1::RunStart run = start();
    auto& setting = *run.add_settings();
    setting.set_name(path);
    setting.set_value("0.5");
    return read_scene(run, embedded).scene;
  };
  EXPECT_EQ(set("arena/box[@id='low']/@mass").entities.size(), 3u);
  for (const std::string path : {"//*[.//*]/@mass", "//*//*/@mass", "//*/following::*/@mass",
                                 "arena/ghost/@mass", "", "@"}) {
    EXPECT_THROW(set(path), scene::SceneError) << path;
  }
  EXPECT_THROW(set(std::string(1 << 20, '/')), scene::SceneError);
}

TEST(EmbeddedScene, TakesNoMoreMemoryThanOneOnTheDisk) {
  EmbeddedFiles embedded;
  embedded.add(
      "scenes/small.argos",
      R"(<argos><framework><experiment ticks_per_second="10"/></framework><controllers>)"
      R"(<external_controller id="c"><actuators/><sensors/><params large=")" +
          std::string(1'000'000, 'x') +
          R"("/></external_controller></controllers><media/><physics_engines><dynamics3d id="d"/></physics_engines>)"
          R"(<arena size="9,9,9"><distribute><position method="uniform" min="0,0,0" max="9,9,9"/>)"
          R"(<orientation method="constant" values="0,0,0"/><entity quantity="5000" max_trials="1"><e-puck id="e">)"
          R"(<controller config="c"/></e-puck></entity></distribute></arena></argos>)");
  EXPECT_TRUE(fails_with<scene::SceneError>("is too many: each of these entities takes some 4.0 MB",
                                            [&] { read_scene(start(), embedded); }));
}

TEST(EmbeddedScene, HasTheRecordedHash) {
  const EmbeddedFiles embedded = files();
  v1::RunStart run = start();
  run.set_scene_hash("0123456789abcdef");
  EXPECT_THROW(read_scene(run, embedded), RecordingError);
  run.set_scene_hash("");
  run.set_clock("sundial");
  EXPECT_THROW(read_scene(run, embedded), RecordingError);
  run.set_clock("beta50");
  EXPECT_EQ(read_scene(run, embedded).scene.physics.clock, scene::Clock::beta50);
  run.set_seed(0);
  EXPECT_THROW(read_scene(run, embedded), RecordingError);
}

TEST(RecordedCore, OfARunThatCanNotBeRepeatedIsToldWithItsVersion) {
  v1::RunStart run = start();
  scene::Scene scene;
  EXPECT_NO_THROW(check_core(run, scene));
  scene.physics.had_second_core = true;
  run.mutable_build()->set_version("0.0.9");
  const std::string words = words_of<RecordingError>([&] { check_core(run, scene); });
  EXPECT_NE(words.find("solver=\"sweeps\""), std::string::npos) << words;
  EXPECT_NE(words.find("0.0.9"), std::string::npos) << words;
  run.set_core(1);
  EXPECT_NO_THROW(check_core(run, scene));
}

}  // namespace
}  // namespace ziggurat::replay
