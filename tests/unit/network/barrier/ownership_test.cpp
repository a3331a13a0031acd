// SPDX-License-Identifier: MIT
#include "network/barrier/ownership.h"

#include <gtest/gtest.h>

namespace ziggurat::network {
namespace {

using namespace std::chrono_literals;

constexpr SessionId one{1}, other{2};

struct Two : ::testing::Test {
  Two() {
    ownership.add(start, InTick::awaited);
    ownership.add(start, InTick::awaited);
  }
  Time start{};
  Ownership ownership;
};

TEST_F(Two, AreWaitedForUntilTheyAreTaken) {
  EXPECT_FALSE(ownership.all_taken());
  EXPECT_TRUE(ownership.is_awaited());
  ownership.take(0, one, start);
  EXPECT_TRUE(ownership.is_awaited());
  ownership.take(1, other, start);
  EXPECT_TRUE(ownership.all_taken());
  EXPECT_FALSE(ownership.is_awaited());
  EXPECT_EQ(ownership[1].holder, other);
  EXPECT_TRUE(ownership[1].was_held);
}

TEST_F(Two, AReleasedOneIsFreeForItsClaimantAndOthers) {
  ownership.take(0, one, start);
  ownership.release(0, one, start + 5s, InTick::awaited, {});
  EXPECT_EQ(ownership[0].holder, SessionId::none);
  EXPECT_EQ(ownership[0].claimant, one);
  EXPECT_EQ(ownership[0].free_since, start + 5s);
  ownership.take(0, other, start);
  EXPECT_EQ(ownership[0].holder, other);
  EXPECT_EQ(ownership[0].claimant, SessionId::none);
}

TEST_F(Two, ASkippedOneIsWaitedForAgainAtTheNextTick) {
  ownership.take(0, one, start);
  ownership.skip(1, start);
  EXPECT_FALSE(ownership.is_awaited());
  EXPECT_FALSE(ownership.all_taken());
  ownership.begin_tick(start);
  EXPECT_TRUE(ownership.is_awaited());
}

TEST_F(Two, OneThatLeftIsNeverWaitedForAgain) {
  ownership.take(0, one, start);
  ownership.skip(1, start);
  ownership.leave(0);
  ownership.leave(1);
  ownership.leave(1);
  EXPECT_TRUE(ownership.all_taken());
  ownership.begin_tick(start);
  EXPECT_FALSE(ownership.is_awaited());
  EXPECT_TRUE(ownership[0].has_left);
  EXPECT_EQ(ownership[0].holder, SessionId::none);
}

TEST_F(Two, ASpawnedOneIsWaitedForFromTheNextTickOn) {
  ownership.take(0, one, start);
  ownership.take(1, one, start);
  ownership.add(start, InTick::skipped);
  EXPECT_FALSE(ownership.all_taken());
  EXPECT_FALSE(ownership.is_awaited());
  ownership.begin_tick(start);
  EXPECT_TRUE(ownership.is_awaited());
  ownership.leave(2);
  ownership.shrink(2);
  EXPECT_EQ(ownership.size(), 2U);
  EXPECT_TRUE(ownership.all_taken());
}

}  // namespace
}  // namespace ziggurat::network
