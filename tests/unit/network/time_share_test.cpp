#include "network/time_share.h"

#include <gtest/gtest.h>

namespace ziggurat::network {
namespace {

using namespace std::chrono_literals;

TEST(TimeShare, WhoUsesItUpGetsItsShareOfTheTime) {
  TimeShare share(0.05, 5ms);
  auto now = std::chrono::steady_clock::now();
  const auto begin = now;
  std::chrono::duration<double> used{0};
  while (now - begin < 10s) {
    if (share.has_some(now)) {
      share.charge(300us);
      used += 300us;
      now += 300us;
    } else {
      now += std::chrono::ceil<std::chrono::nanoseconds>(share.time_until_some()) + 1us;
    }
  }
  EXPECT_NEAR(used.count(), 0.05 * 10, 0.01);
}

TEST(TimeShare, LittleIsSavedUp) {
  TimeShare share(0.05, 5ms);
  const auto later = std::chrono::steady_clock::now() + 1h;
  EXPECT_TRUE(share.has_some(later));
  share.charge(6ms);
  EXPECT_FALSE(share.has_some(later));
  EXPECT_NEAR(share.time_until_some().count(), (0.001 + TimeShare::least.count()) / 0.05, 1e-6);
}

TEST(TimeShare, ItsTurnsAreNotShorterThanWorthwhile) {
  TimeShare share(0.05, 5ms);
  auto now = std::chrono::steady_clock::now();
  share.charge(5ms);
  int turns = 0;
  for (int i = 0; i < 10'000; ++i) {
    now += 100us;
    if (!share.has_some(now)) continue;
    ++turns;
    share.charge(TimeShare::least);
  }
  EXPECT_NEAR(turns, 100, 5) << "5 % of a second, in turns of half a millisecond";
}

TEST(TimeShare, TwentyMillisecondsAreOwedInFullAndNoMore) {
  for (const std::chrono::nanoseconds used : {std::chrono::nanoseconds(20ms), std::chrono::nanoseconds(1h)}) {
    TimeShare share(0.05, 5ms);
    const auto now = std::chrono::steady_clock::now();
    EXPECT_TRUE(share.has_some(now));
    share.charge(used);
    EXPECT_FALSE(share.has_some(now));
    EXPECT_FALSE(share.has_some(now + 300ms));
    EXPECT_TRUE(share.has_some(now + 450ms));
  }
}

}  // namespace
}  // namespace ziggurat::network
