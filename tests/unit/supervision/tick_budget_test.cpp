#include "supervision/tick_budget.h"

#include <gtest/gtest.h>

#include <thread>

#include "supervision/supervision.h"

namespace ziggurat::supervision {
namespace {

using namespace std::chrono_literals;

TEST(TickBudget, NamesThePhasesThatHaveAnyTime) {
  TickBudget budget;
  budget.add(Phase::physics, 0.25);
  budget.add(Phase::pacing, 0.5);
  wire::Status status;
  budget.fill(status);
  ASSERT_EQ(status.budget.size(), 2U);
  EXPECT_EQ(status.budget[0].phase, "physics");
  EXPECT_FLOAT_EQ(static_cast<float>(status.budget[0].wall.max), 0.25F);
  EXPECT_EQ(status.budget[1].phase, "pacing");
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
