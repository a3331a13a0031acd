// SPDX-License-Identifier: MIT
#include "simulation/placement.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "small_scene.h"

namespace ziggurat::simulation {
namespace {

using namespace testing;

/// A box that covers all places for another.
scene::Scene full(const std::string& max_trials) {
  SmallScene text;
  text.arena =
      R"(<box id="big" size="3,3,1" movable="false"><body position="0,0,0"/></box><distribute>)"
      R"(<position method="uniform" min="-1,-1,0" max="1,1,0"/>)"
      R"(<orientation method="constant" values="0,0,0"/><entity quantity="2" max_trials=")" +
      max_trials + R"("><box id="b" size=".1,.1,.1" movable="false"/></entity></distribute>)";
  return text.read();
}

/// Ten boxes in a row.
scene::Scene free_of_overlaps() {
  SmallScene text;
  text.arena =
      R"(<distribute><position method="grid" center="0,0,9" distances="1,1,1" layout="10,1,1"/>)"
      R"(<orientation method="constant" values="0,0,0"/><entity quantity="10" max_trials="1">)"
      R"(<box id="b" size=".1,.1,.1" movable="false"/></entity></distribute>)";
  return text.read();
}

std::string fault_of(const scene::Scene& scene, SearchLimits limits) {
  try {
    place_entities(scene, 1, {}, limits);
  } catch (const scene::SceneError& error) {
    return scene::to_string(error.problems().at(0));
  }
  return {};
}

TEST(Place, TriesAsOftenAsTheSceneSays) {
  EXPECT_NE(fault_of(full("7"), {1000})
                .find("no free place for 'b0' in 8 attempts, after 0 of 2 were placed"),
            std::string::npos);
}

TEST(Place, GivesUpAtTheLimitOfASceneWhateverItSays) {
  const std::string fault = fault_of(full("4294967295"), {1000});
  EXPECT_TRUE(fault.starts_with("small.argos:1:")) << fault;
  EXPECT_NE(fault.find("no free place for 'b0' in 1000 attempts, and a scene has 1000 in all"),
            std::string::npos)
      << fault;
  EXPECT_NE(fault.find("widen the range or place fewer"), std::string::npos) << fault;
}

TEST(Place, GivesUpWhenFailingTakesTooMuch) {
  const std::string fault = fault_of(full("4294967295"), {1'000'000'000, 1600});
  EXPECT_NE(fault.find("no free place for 'b0' in 100 attempts, each so long that a scene has no "
                       "more, after 0 of 2"),
            std::string::npos)
      << fault;
  EXPECT_NE(fault.find("widen the range or place fewer"), std::string::npos) << fault;
}

TEST(Place, GivesUpWhenSucceedingTakesTooMuch) {
  const scene::Scene sound = free_of_overlaps();
  EXPECT_EQ(fault_of(sound, {}), "");
  const std::string fault = fault_of(sound, {1000, 1600, 20});
  EXPECT_NE(fault.find("<distribute>: it takes too long to find places, after 4 of 10 were found"),
            std::string::npos)
      << fault;
}

TEST(Place, TellsHowFarItIsWhileItTries) {
  std::vector<std::pair<std::size_t, std::size_t>> told;
  const auto tell = [&](Step, std::size_t placed, std::size_t all) {
    told.emplace_back(placed, all);
  };
  EXPECT_THROW(place_entities(full("4294967295"), 1, tell, {25'000}), scene::SceneError);
  EXPECT_EQ(told, (std::vector<std::pair<std::size_t, std::size_t>>{{0, 2}, {0, 2}}));
}

TEST(Place, TellsHowManyEntitiesHaveBodies) {
  SmallScene text;
  for (int i = 0; i < 250; ++i) {
    text.arena += "<box id=\"b" + std::to_string(i) +
                  R"(" size=".1,.1,.1" movable="false"><body position=")" + std::to_string(i) +
                  R"(,0,0" orientation="0,0,0"/></box>)";
  }
  std::vector<std::size_t> built;
  const auto tell = [&](Step step, std::size_t done, std::size_t all) {
    EXPECT_EQ(step, Step::building);
    EXPECT_EQ(all, 250u);
    built.push_back(done);
  };
  const Simulation simulation(text.read(), {1, tell});
  EXPECT_EQ(built, (std::vector<std::size_t>{0, 100, 200}));
}

}  // namespace
}  // namespace ziggurat::simulation
