#include "text/duration.h"

#include <gtest/gtest.h>

namespace ziggurat::text {
namespace {

TEST(Duration, HasTwoUnitsAtMostAndIsRoundedUp) {
  EXPECT_EQ(to_duration(0), "0 s");
  EXPECT_EQ(to_duration(44.2), "45 s");
  EXPECT_EQ(to_duration(59.5), "1 min 0 s");
  EXPECT_EQ(to_duration(200), "3 min 20 s");
  EXPECT_EQ(to_duration(7500), "2 h 5 min");
}

}  // namespace
}  // namespace ziggurat::text
