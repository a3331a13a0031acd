// SPDX-License-Identifier: MIT
#include "run/options/deadline_option.h"

#include <gtest/gtest.h>

#include "run/options.h"
#include "run/setup.h"
#include "text/numbers.h"
#include "words_of.h"

namespace ziggurat::run {
namespace {

using scene::DeadlineAction;
using scene::DeadlinePolicy;

TEST(DeadlineOption, ActionDeadlineAndBudget) {
  EXPECT_EQ(to_deadline("wait").policy, DeadlinePolicy{});
  EXPECT_EQ(to_deadline("hold:50").policy, (DeadlinePolicy{DeadlineAction::hold, 50, 0}));
  EXPECT_EQ(to_deadline("zero:5:10").policy, (DeadlinePolicy{DeadlineAction::zero, 5, 10}));
  const auto named = to_deadline("a=b=stop:1000");
  EXPECT_EQ(named.controller, "a=b");
  EXPECT_EQ(named.policy.action, DeadlineAction::stop);
}

TEST(DeadlineOption, WrongTextsAreRefused) {
  for (const char* text :
       {"", "hold", "hold:", "hold:0", "hold:-1", "hold:50:", "hold:5:1:2", "wait:5", "kill:5",
        "=hold:5", "drive=", "hold:99999999999", "hold:5:x", "hold:5.5"}) {
    EXPECT_THROW(to_deadline(text), text::UsageError) << text;
  }
}

TEST(DeadlineOption, ThoseThatNameAControllerWin) {
  scene::Scene scene;
  scene.controllers.resize(3);
  scene.controllers[0].id = "drive";
  scene.controllers[1].id = "lift";
  scene.controllers[2].id = "look";
  const std::vector options{to_deadline("lift=drop:7"), to_deadline("hold:50"),
                            to_deadline("look=zero:1"), to_deadline("look=zero:2")};
  const auto deadlines = deadlines_of(options, scene).all;
  ASSERT_EQ(deadlines.size(), 3U);
  EXPECT_EQ(deadlines[0].policy.action, DeadlineAction::hold);
  EXPECT_EQ(deadlines[1].policy.wall_deadline_ms, 7U);
  EXPECT_EQ(deadlines[2].policy.wall_deadline_ms, 2U);
  EXPECT_TRUE(deadlines[0].is_fixed);
  EXPECT_FALSE(deadlines_of({}, scene).all[0].is_fixed);
  EXPECT_THROW(deadlines_of({to_deadline("unknown=wait")}, scene), text::UsageError);
}

scene::Scene scene_with_directors() {
  scene::Scene scene;
  scene.controllers.resize(1);
  scene.controllers[0].id = "drive";
  scene.directors.resize(2);
  scene.directors[0].id = "judge";
  scene.directors[1].id = "food";
  scene.directors[1].deadline = {DeadlineAction::drop, 30, 2};
  return scene;
}

TEST(DeadlineOption, DirectorsAreNamedAsControllersAre) {
  const scene::Scene scene = scene_with_directors();
  const auto named = deadlines_of({to_deadline("judge=zero:7")}, scene);
  ASSERT_EQ(named.all.size(), 3U);
  EXPECT_FALSE(named.all[0].is_fixed);
  EXPECT_EQ(named.all[1].policy, (DeadlinePolicy{DeadlineAction::zero, 7, 0}));
  EXPECT_TRUE(named.all[1].is_fixed);
  EXPECT_EQ(named.all[2].policy, (DeadlinePolicy{DeadlineAction::drop, 30, 2}));
  EXPECT_FALSE(named.of_others.is_fixed);
  const auto all = deadlines_of({to_deadline("hold:50")}, scene);
  for (const auto& each : all.all) EXPECT_EQ(each.policy.wall_deadline_ms, 50U);
  EXPECT_EQ(all.of_others.policy.wall_deadline_ms, 50U);
  EXPECT_TRUE(
      fails_with<text::UsageError>("no controller or director 'juge'; did you mean 'judge'",
                                   [&] { deadlines_of({to_deadline("juge=hold:5")}, scene); }));
}

TEST(DeadlineOption, NoOneIsWaitedForInHardwareInTheLoop) {
  scene::Scene scene = scene_with_directors();
  scene.experiment.ticks_per_second = 10;
  Options options;
  options.hil = true;
  network::Config config;
  add_controllers(options, scene, config);
  const DeadlinePolicy after_90_ms{DeadlineAction::hold, 90, 0};
  EXPECT_EQ(config.deadlines[0].policy, after_90_ms);
  EXPECT_EQ(config.deadlines[1].policy, after_90_ms);
  EXPECT_EQ(config.deadlines[2].policy, (DeadlinePolicy{DeadlineAction::drop, 30, 2}));
  EXPECT_EQ(config.deadline_of_others.policy, after_90_ms);
  options.deadlines = {to_deadline("judge=wait")};
  add_controllers(options, scene, config);
  EXPECT_EQ(config.deadlines[1].policy, DeadlinePolicy{});
}

TEST(DeadlineOption, TheSceneAppliesWithoutAnOption) {
  scene::Scene scene;
  scene.controllers.resize(2);
  scene.controllers[0].id = "drive";
  scene.controllers[1].id = "lift";
  for (auto& each : scene.controllers) each.deadline = {DeadlineAction::zero, 30, 2};
  const auto deadlines = deadlines_of({to_deadline("lift=hold:5")}, scene).all;
  EXPECT_EQ(deadlines[0].policy, (DeadlinePolicy{DeadlineAction::zero, 30, 2}));
  EXPECT_FALSE(deadlines[0].is_fixed);  // a Hello may ask for another policy
  EXPECT_EQ(deadlines[1].policy, (DeadlinePolicy{DeadlineAction::hold, 5, 0}));
  EXPECT_TRUE(deadlines[1].is_fixed);
}

}  // namespace
}  // namespace ziggurat::run
