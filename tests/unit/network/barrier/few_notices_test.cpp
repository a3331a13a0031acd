#include "network/barrier/few_notices.h"

#include <gtest/gtest.h>

namespace ziggurat::network {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr FewNotices::Time start{std::chrono::hours(1)};

/// How many of so many at once are told.
int told_of(FewNotices& notices, int count, FewNotices::Time now) {
  int told = 0;
  for (int i = 0; i < count; ++i) told += notices.add("Wrong.", now) ? 1 : 0;
  return told;
}

TEST(FewNotices, TwentyAreToldAtOnceAsTheyAre) {
  FewNotices notices;
  for (int i = 0; i < 20; ++i) EXPECT_EQ(notices.add("Wrong.", start), "Wrong.");
  EXPECT_EQ(notices.add("Wrong.", start), std::nullopt);
}

TEST(FewNotices, ThenOneASecondWithTheNumberOfTheOthers) {
  FewNotices notices;
  EXPECT_EQ(told_of(notices, 23, start), 20);
  EXPECT_EQ(notices.add("Late.", start + milliseconds(999)), std::nullopt);
  EXPECT_EQ(notices.add("Wrong.", start + milliseconds(1000)), "Wrong. (4 more before it.)");
  EXPECT_EQ(notices.add("Wrong.", start + milliseconds(1999)), std::nullopt);
  EXPECT_EQ(notices.add("Wrong.", start + milliseconds(2000)), "Wrong. (1 more before it.)");
}

TEST(FewNotices, PartsOfASecondAreNotLost) {
  FewNotices notices;
  EXPECT_EQ(told_of(notices, 20, start), 20);
  int told = 0;
  for (int i = 1; i <= 100; ++i) told += told_of(notices, 1, start + i * milliseconds(300));
  EXPECT_EQ(told, 30);
}

TEST(FewNotices, AfterALongTimeThereAreTwentyAgainAndNoMore) {
  FewNotices notices;
  EXPECT_EQ(told_of(notices, 1000, start), 20);
  const auto later = start + std::chrono::hours(24);
  EXPECT_EQ(notices.add("Wrong.", later), "Wrong. (980 more before it.)");
  EXPECT_EQ(told_of(notices, 1000, later), 19);
  EXPECT_EQ(told_of(notices, 1000, later + seconds(3)), 3);
}

}  // namespace
}  // namespace ziggurat::network
