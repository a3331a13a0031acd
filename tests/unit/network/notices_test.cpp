// SPDX-License-Identifier: MIT
#include "network/notices.h"

#include <gtest/gtest.h>

namespace ziggurat::network {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Notices::Time start{std::chrono::hours(1)};

/// Number of sentences that are printed of so many at once.
std::size_t told_of(Notices& notices, int count, Notices::Time now) {
  for (int i = 0; i < count; ++i) notices.add("Wrong.", now);
  return notices.take().size();
}

TEST(Notices, TwentyAreToldAtOnceAsTheyAre) {
  Notices notices;
  for (int i = 0; i < 21; ++i) notices.add("Wrong.", start);
  EXPECT_EQ(notices.take(), std::vector<std::string>(20, "Wrong."));
}

TEST(Notices, ThenOneASecondWithTheNumberOfTheOthers) {
  Notices notices;
  EXPECT_EQ(told_of(notices, 23, start), 20U);
  EXPECT_EQ(told_of(notices, 1, start + milliseconds(999)), 0U);
  notices.add("Last.", start + milliseconds(1000));
  EXPECT_EQ(notices.take(), std::vector<std::string>{"Last. (4 more before it.)"});
}

TEST(Notices, TheLastOneIsToldThoughNoOtherFollows) {
  Notices notices;
  told_of(notices, 22, start);
  notices.add("Last.", start);
  notices.tell_last(start + milliseconds(999));
  EXPECT_TRUE(notices.take().empty());
  notices.tell_last(start + milliseconds(1000));
  EXPECT_EQ(notices.take(), std::vector<std::string>{"Last. (2 more before it.)"});
  notices.tell_last(start + seconds(10));
  EXPECT_TRUE(notices.take().empty());
}

TEST(Notices, PartsOfASecondAreNotLost) {
  Notices notices;
  EXPECT_EQ(told_of(notices, 20, start), 20U);
  std::size_t told = 0;
  for (int i = 1; i <= 100; ++i) told += told_of(notices, 1, start + i * milliseconds(300));
  EXPECT_NEAR(static_cast<double>(told), 30, 1);
}

TEST(Notices, AfterALongTimeThereAreTwentyAgainAndNoMore) {
  Notices notices;
  EXPECT_EQ(told_of(notices, 1000, start), 20U);
  const auto later = start + std::chrono::hours(24);
  EXPECT_EQ(told_of(notices, 1000, later), 20U);
  EXPECT_EQ(told_of(notices, 1000, later + seconds(3)), 3U);
}

}  // namespace
}  // namespace ziggurat::network
