// SPDX-License-Identifier: MIT
#include "cli/installed_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "text/numbers.h"
#include "words_of.h"

namespace ziggurat::cli {
namespace {

TEST(FirstSentence, IsThatOfTheCommentAtTheBeginning) {
  EXPECT_EQ(first_sentence("<?xml version=\"1.0\"?>\n<!-- Boxes of 1 cm fall\n     onto the floor "
                           "(Listing 2.1). Look for: heaps. -->\n<argos-configuration>"),
            "Boxes of 1 cm fall onto the floor (Listing 2.1).");
  EXPECT_EQ(first_sentence("<!-- A tower looks around: sensors at work. --><argos-configuration/>"),
            "A tower looks around.");
  EXPECT_EQ(first_sentence("<argos-configuration><!-- Inside. --></argos-configuration>"), "");
  EXPECT_EQ(first_sentence("<!-- without end"), "without end");
  EXPECT_EQ(first_sentence(""), "");
}

TEST(ScenePath, IsAFileThatIsThere) { EXPECT_EQ(scene_path("/dev/null"), "/dev/null"); }

TEST(ScenePath, LeavesMissingFilesToTheReader) {
  EXPECT_EQ(scene_path("nowhere/x.argos"), "nowhere/x.argos");
  EXPECT_EQ(scene_path("x.argos"), "x.argos");
}

TEST(ScenePath, FindsInstalledScenesByName) {
  EXPECT_TRUE(scene_path("vehicle").ends_with("/scenes/vehicle.argos"));
  EXPECT_TRUE(scene_path("construction/steps").ends_with("/scenes/construction/steps.argos"));
  const std::string words = words_of<text::UsageError>([] { scene_path("vehcile"); });
  EXPECT_TRUE(words.ends_with("did you mean 'vehicle'?")) << words;
}

TEST(InstalledScenes, AreListedOnceAndWithoutModels) {
  const auto scenes = installed_scenes();
  const auto count = [&](const std::string& name) {
    return std::ranges::count(scenes, name, &InstalledScene::name);
  };
  EXPECT_EQ(count("vehicle"), 1);
  EXPECT_EQ(count("dynamics3d_multi_body_test"), 0);
  EXPECT_EQ(count("models/block"), 0);
}

}  // namespace
}  // namespace ziggurat::cli
