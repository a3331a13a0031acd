#include "run/deadline_option.h"

#include <gtest/gtest.h>

#include "text/numbers.h"

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
  const auto deadlines = deadlines_of(options, scene);
  ASSERT_EQ(deadlines.size(), 3U);
  EXPECT_EQ(deadlines[0].policy.action, DeadlineAction::hold);
  EXPECT_EQ(deadlines[1].policy.wall_deadline_ms, 7U);
  EXPECT_EQ(deadlines[2].policy.wall_deadline_ms, 2U);
  EXPECT_TRUE(deadlines[0].is_fixed);
  EXPECT_FALSE(deadlines_of({}, scene)[0].is_fixed);
  EXPECT_THROW(deadlines_of({to_deadline("unknown=wait")}, scene), text::UsageError);
}

TEST(DeadlineOption, TheSceneAppliesWithoutAnOption) {
  scene::Scene scene;
  scene.controllers.resize(2);
  scene.controllers[0].id = "drive";
  scene.controllers[1].id = "lift";
  for (auto& each : scene.controllers) each.deadline = {DeadlineAction::zero, 30, 2};
  const auto deadlines = deadlines_of({to_deadline("lift=hold:5")}, scene);
  EXPECT_EQ(deadlines[0].policy, (DeadlinePolicy{DeadlineAction::zero, 30, 2}));
  EXPECT_FALSE(deadlines[0].is_fixed);  // a Hello may ask for another policy
  EXPECT_EQ(deadlines[1].policy, (DeadlinePolicy{DeadlineAction::hold, 5, 0}));
  EXPECT_TRUE(deadlines[1].is_fixed);
}

}  // namespace
}  // namespace ziggurat::run
