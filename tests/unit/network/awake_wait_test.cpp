// SPDX-License-Identifier: MIT
#include "network/awake_wait.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

namespace ziggurat::network {
namespace {

class AwakeWaits : public testing::Test {
 protected:
  /// So many threads run or are ready.
  void set_ready(int threads) {
    std::ofstream(load_) << "0.52 0.48 0.50 " << threads << "/812 4711\n";
  }
  AwakeWait on(std::size_t processors) const { return AwakeWait(processors, load_); }

  const std::string load_ = testing::TempDir() + "awake_wait_load";
};

TEST_F(AwakeWaits, AnAnswerThatComesSoonIsSeenWithoutSleep) {
  set_ready(2);
  AwakeWait wait = on(2);
  ASSERT_TRUE(wait.is_worth_it(1));
  int looks = 0;
  EXPECT_TRUE(wait.until([&] { return ++looks == 3; }));
  EXPECT_EQ(looks, 3);
  EXPECT_TRUE(wait.is_worth_it(1));
}

TEST_F(AwakeWaits, TriesGetRareWhileTheyAreInVain) {
  set_ready(1);
  AwakeWait wait = on(2);
  int tries = 0;
  for (int tick = 0; tick < 640; ++tick) {
    if (!wait.is_worth_it(1)) continue;
    ++tries;
    EXPECT_FALSE(wait.until([] { return false; }));
  }
  // At the ticks 0, 2, 6, 14, 30, 62, 126 and each 64th from there on.
  EXPECT_EQ(tries, 15);
}

TEST_F(AwakeWaits, AThreadThatWantsAProcessorHasItAtOnce) {
  set_ready(3);
  AwakeWait wait = on(2);
  ASSERT_TRUE(wait.is_worth_it(1));
  int looks = 0;
  EXPECT_FALSE(wait.until([&] {
    ++looks;
    return false;
  }));
  EXPECT_LT(looks, 10);
  set_ready(1);
  for (int tick = 0; tick < 63; ++tick) EXPECT_FALSE(wait.is_worth_it(1));
  EXPECT_TRUE(wait.is_worth_it(1));
}

TEST_F(AwakeWaits, EachAnswerThatIsAwaitedNeedsAProcessor) {
  set_ready(1);
  EXPECT_FALSE(on(2).is_worth_it(0));
  EXPECT_FALSE(on(1).is_worth_it(1));
  EXPECT_FALSE(on(2).is_worth_it(2));
  EXPECT_TRUE(on(8).is_worth_it(7));
}

TEST_F(AwakeWaits, WithoutTheFileOfTheSystemItSleeps) {
  EXPECT_FALSE(AwakeWait(8, "/nowhere").is_worth_it(1));
  std::ofstream(load_) << "nonsense";
  AwakeWait wait = on(8);
  ASSERT_TRUE(wait.is_worth_it(1));
  EXPECT_FALSE(wait.until([] { return false; }));
}

}  // namespace
}  // namespace ziggurat::network
