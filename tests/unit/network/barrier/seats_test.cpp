#include "network/barrier/seats.h"

#include <gtest/gtest.h>

namespace ziggurat::network {
namespace {

using namespace std::chrono_literals;

constexpr SessionId one{1}, other{2};

struct Two : ::testing::Test {
  Two() {
    seats.add(start, false);
    seats.add(start, false);
  }
  Time start{};
  Seats seats;
};

TEST_F(Two, AreWaitedForUntilTheyAreTaken) {
  EXPECT_FALSE(seats.all_taken());
  EXPECT_TRUE(seats.is_awaited());
  seats.take(0, one, start);
  EXPECT_TRUE(seats.is_awaited());
  seats.take(1, other, start);
  EXPECT_TRUE(seats.all_taken());
  EXPECT_FALSE(seats.is_awaited());
  EXPECT_EQ(seats[1].holder, other);
  EXPECT_TRUE(seats[1].was_held);
}

TEST_F(Two, AReleasedOneIsFreeForItsClaimantAndOthers) {
  seats.take(0, one, start);
  seats.release(0, one, start + 5s, false, {});
  EXPECT_EQ(seats[0].holder, SessionId::none);
  EXPECT_EQ(seats[0].claimant, one);
  EXPECT_EQ(seats[0].free_since, start + 5s);
  seats.take(0, other, start);
  EXPECT_EQ(seats[0].holder, other);
  EXPECT_EQ(seats[0].claimant, SessionId::none);
}

TEST_F(Two, ASkippedOneIsWaitedForAgainAtTheNextTick) {
  seats.take(0, one, start);
  seats.skip(1, start);
  EXPECT_FALSE(seats.is_awaited());
  EXPECT_FALSE(seats.all_taken());
  seats.begin_tick(start);
  EXPECT_TRUE(seats.is_awaited());
}

TEST_F(Two, OneThatLeftIsNeverWaitedForAgain) {
  seats.take(0, one, start);
  seats.skip(1, start);
  seats.leave(0);
  seats.leave(1);
  seats.leave(1);
  EXPECT_TRUE(seats.all_taken());
  seats.begin_tick(start);
  EXPECT_FALSE(seats.is_awaited());
  EXPECT_TRUE(seats[0].has_left);
  EXPECT_EQ(seats[0].holder, SessionId::none);
}

TEST_F(Two, ASpawnedOneIsWaitedForFromTheNextTickOn) {
  seats.take(0, one, start);
  seats.take(1, one, start);
  seats.add(start, true);
  EXPECT_FALSE(seats.all_taken());
  EXPECT_FALSE(seats.is_awaited());
  seats.begin_tick(start);
  EXPECT_TRUE(seats.is_awaited());
  seats.leave(2);
  seats.shrink(2);
  EXPECT_EQ(seats.size(), 2U);
  EXPECT_TRUE(seats.all_taken());
}

}  // namespace
}  // namespace ziggurat::network
