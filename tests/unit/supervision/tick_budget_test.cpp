// SPDX-License-Identifier: MIT
#include "supervision/tick_budget.h"

#include <gtest/gtest.h>

#include <thread>

#include "supervision/supervision.h"

namespace ziggurat::supervision {
namespace {

using namespace std::chrono_literals;

TEST(TickBudget, NamesThePhasesThatHaveAnyTime) {
  TickBudget budget;
  timing::PhaseTimes tick;
  tick[timing::Phase::startup] = 9;
  tick[timing::Phase::solve] = 0.25;
  budget.add(tick);
  tick[timing::Phase::pacing] = 0.5;
  budget.add(tick);
  wire::Status status;
  budget.fill(status);
  ASSERT_EQ(status.budget.size(), 2U);
  EXPECT_EQ(status.budget[0].phase, "solve");
  EXPECT_FLOAT_EQ(static_cast<float>(status.budget[0].wall.max), 0.25F);
  EXPECT_EQ(status.budget[1].phase, "pacing");
}

TEST(TickBudget, HasPercentilesOfTheLastTicks) {
  TickBudget budget;
  timing::PhaseTimes tick;
  tick[timing::Phase::wait] = 50;
  budget.add(tick);
  for (std::size_t i = TickBudget::remembered; i > 0; --i) {
    tick[timing::Phase::wait] = 1e-3 * static_cast<double>(i);
    budget.add(tick);
  }
  wire::Status status;
  budget.fill(status);
  ASSERT_EQ(status.budget.size(), 1U);
  EXPECT_FLOAT_EQ(static_cast<float>(status.budget[0].wall.p50), 0.5F);
  EXPECT_FLOAT_EQ(static_cast<float>(status.budget[0].wall.p99), 0.99F);
  EXPECT_FLOAT_EQ(static_cast<float>(status.budget[0].wall.max), 1);
}

TEST(PauseTimer, AddsUpThePauses) {
  PauseTimer timer;
  timer.update(false);
  EXPECT_EQ(timer.total(), 0ns);
  for (int i = 0; i < 2; ++i) {
    timer.update(true);
    timer.update(true);                // the same pause
    std::this_thread::sleep_for(2ms);  // elapsed time is the subject
    timer.update(false);
  }
  const auto total = timer.total();
  EXPECT_GE(total, 4ms);
  std::this_thread::sleep_for(1ms);
  EXPECT_EQ(timer.total(), total) << "it only counts while the world is paused";
}

}  // namespace
}  // namespace ziggurat::supervision
