// SPDX-License-Identifier: MIT
#include "network/barrier/deadlines.h"

#include <gtest/gtest.h>

namespace ziggurat::network {
namespace {

using scene::DeadlineAction;
using scene::DeadlinePolicy;

/// Robots 0 and 1 of controller 0, robot 2 of controller 1, which waits.
struct Three : ::testing::Test {
  explicit Three(const DeadlinePolicy& policy = {DeadlineAction::hold, 50, 0})
      : deadlines({{policy, true}}, 2) {
    deadlines.add(0);
    deadlines.add(0);
    deadlines.add(1);
  }
  Deadlines deadlines;
};

TEST_F(Three, HaveThePolicyOfTheirController) {
  EXPECT_EQ(deadlines.policy(0).action, DeadlineAction::hold);
  EXPECT_EQ(deadlines.policy(2).action, DeadlineAction::wait);
  const DeadlinePolicy wish{DeadlineAction::zero, 20, 0};
  EXPECT_TRUE(deadlines.fixed_against(0, wish));
  EXPECT_FALSE(deadlines.fixed_against(0, deadlines.policy(0)));
  EXPECT_FALSE(deadlines.fixed_against(2, wish));
  deadlines.set_policy(2, wish);
  EXPECT_EQ(deadlines.policy(2), wish);
  deadlines.set_policy(2, {});
  EXPECT_EQ(deadlines.policy(2).action, DeadlineAction::wait);
}

TEST_F(Three, TicksAreCountedOncePerController) {
  deadlines.miss(0, 4);
  deadlines.miss(1, 4);
  deadlines.miss(0, 5);
  EXPECT_EQ(deadlines.missed_ticks(), (std::vector<std::uint64_t>{2, 0}));
  EXPECT_EQ(deadlines.misses_in_row(0), 2U);
  deadlines.forgive(0);
  EXPECT_EQ(deadlines.misses_in_row(0), 0U);
  deadlines.reset();
  EXPECT_EQ(deadlines.misses_in_row(1), 0U);
  EXPECT_EQ(deadlines.missed_ticks()[0], 2U) << "what was counted stays";
  deadlines.miss(0, 5);
  EXPECT_EQ(deadlines.missed_ticks()[0], 3U) << "that is another tick 5";
}

/// Consequences after one miss, two and three.
std::vector<Consequence> consequences(DeadlineAction action, std::uint32_t budget) {
  Deadlines deadlines({{{action, 50, budget}, false}}, 1);
  deadlines.add(0);
  std::vector<Consequence> result;
  for (std::uint64_t tick = 0; tick < 3; ++tick) result.push_back(deadlines.miss(0, tick));
  return result;
}

TEST(Consequences, FollowTheTableOfTheProtocol) {
  using C = Consequence;
  using All = std::vector<Consequence>;
  EXPECT_EQ(consequences(DeadlineAction::wait, 1), (All{C::none, C::none, C::none}));
  EXPECT_EQ(consequences(DeadlineAction::hold, 0), (All{C::none, C::none, C::none}));
  EXPECT_EQ(consequences(DeadlineAction::hold, 2), (All{C::none, C::none, C::drop}));
  EXPECT_EQ(consequences(DeadlineAction::zero, 0), (All{C::zero, C::zero, C::zero}));
  EXPECT_EQ(consequences(DeadlineAction::zero, 2), (All{C::zero, C::zero, C::drop}));
  EXPECT_EQ(consequences(DeadlineAction::drop, 0), (All{C::drop, C::drop, C::drop}));
  EXPECT_EQ(consequences(DeadlineAction::drop, 1), (All{C::none, C::drop, C::drop}));
  EXPECT_EQ(consequences(DeadlineAction::stop, 1), (All{C::none, C::stop, C::stop}));
}

TEST(Consequences, AZeroHoldsUntilItIsCleared) {
  Deadlines deadlines({{{DeadlineAction::zero, 50, 0}, false}}, 1);
  deadlines.add(0);
  EXPECT_FALSE(deadlines.is_zeroed(0));
  deadlines.miss(0, 1);
  EXPECT_TRUE(deadlines.is_zeroed(0));
  deadlines.clear_zero(0);
  EXPECT_FALSE(deadlines.is_zeroed(0));
}

}  // namespace
}  // namespace ziggurat::network
