// SPDX-License-Identifier: MIT
#include "reports/progress.h"

#include <gtest/gtest.h>

namespace ziggurat::reports {
namespace {

TEST(Progress, HasTotalShareAndTimeLeft) {
  EXPECT_EQ(reached(0, 600, 0.1, 0), "t = 0.00 of 60.00 s (0 %)");
  EXPECT_EQ(reached(150, 600, 0.1, 100), "t = 15.00 of 60.00 s (25 %), 5 s left");
  EXPECT_EQ(reached(599, 600, 0.1, 1000), "t = 59.90 of 60.00 s (99 %), 1 s left");
  EXPECT_EQ(reached(600, 600, 0.1, 1000), "t = 60.00 of 60.00 s (100 %), 0 s left");
  EXPECT_EQ(reached(0, 20'000, 0.1, 100), "t = 0.00 of 2000.00 s (0 %), 3 min 20 s left");
  EXPECT_EQ(reached(0, 750'000, 0.1, 100), "t = 0.00 of 75000.00 s (0 %), 2 h 5 min left");
}

TEST(Progress, TellsWhomItWaitsForWithin80Columns) {
  const Speed at{1, 20, 0.1, 0.2, 0.3};
  EXPECT_EQ(progress_line(at, "r2: lim/bad.lua:3"),
            "t = 0.10 of 2.00 s (5 %), waiting for r2: lim/bad.lua:3");
  EXPECT_EQ(progress_line({10, 20, 0.1, 5, 5}, ""),
            "t = 1.00 of 2.00 s (50 %), 2 s left, real-time factor 0.50, 5 ticks/s");
}

TEST(Progress, OfARunWithoutEndHasTheTimeOnly) {
  EXPECT_EQ(reached(150, std::nullopt, 0.1, 100), "t = 15.00 s");
}

}  // namespace
}  // namespace ziggurat::reports
