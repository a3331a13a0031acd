// SPDX-License-Identifier: MIT
#include "network/barrier/tick_gate.h"

#include <gtest/gtest.h>

namespace ziggurat::network {
namespace {

using Hold = TickGate::Hold;

/// Two sessions owe an answer to tick 7.
struct Gate : ::testing::Test {
  Gate() {
    gate.begin(7);
    gate.await(first, now);
    gate.await(second, now);
  }
  Time now{};
  Ownership ownership;
  Ownership directors;
  TickGate gate{ownership, directors};
  PendingAnswer first, second;
};

TEST_F(Gate, OpensWhenAllHaveAnswered) {
  EXPECT_FALSE(gate.is_complete());
  gate.settle(first, now);
  gate.settle(first, now);  // no second time
  EXPECT_FALSE(gate.is_complete());
  gate.settle(second, now);
  EXPECT_TRUE(gate.is_complete());
}

TEST_F(Gate, AMissIsAsGoodAsAnAnswer) {
  gate.settle(first, now);
  gate.miss(second, now);
  EXPECT_TRUE(gate.is_complete());
  EXPECT_TRUE(gate.has_missed(second));
  EXPECT_FALSE(gate.has_missed(first));
  EXPECT_EQ(second.late_commands, 1U);
  gate.begin(8);
  EXPECT_FALSE(gate.has_missed(second)) << "that was another tick";
}

TEST_F(Gate, AwaitingTwiceOwesOnce) {
  gate.await(first, now);
  gate.settle(first, now);
  gate.settle(second, now);
  EXPECT_TRUE(gate.is_complete());
}

TEST_F(Gate, WaitsForFreeRobots) {
  gate.settle(first, now);
  gate.settle(second, now);
  ownership.add(now, InTick::awaited);
  EXPECT_FALSE(gate.is_complete());
  ownership.skip(0, now);
  EXPECT_TRUE(gate.is_complete());
}

TEST_F(Gate, StaysClosedWhilePausedOrStopped) {
  gate.settle(first, now);
  gate.settle(second, now);
  for (const Hold hold : {Hold::paused, Hold::stopped}) {
    gate.hold(hold);
    EXPECT_FALSE(gate.is_complete());
    EXPECT_TRUE(gate.is_answered());
    gate.release(hold);
    EXPECT_TRUE(gate.is_complete());
  }
}

TEST_F(Gate, ATickEndsThatTheWorldStands) {
  gate.set_halted(true);
  gate.begin(8);
  EXPECT_FALSE(gate.is_halted());
  gate.clear();
  EXPECT_FALSE(gate.tick());
}

TEST_F(Gate, ACommandIsForTheTickThatIsOwed) {
  const auto code = [&](std::uint64_t tick) {
    const auto fault = check_tick(first, tick);
    return fault ? fault->code : wire::ErrorCode::unspecified;
  };
  EXPECT_EQ(code(6), wire::ErrorCode::stale_tick);
  EXPECT_EQ(code(7), wire::ErrorCode::unspecified);
  EXPECT_EQ(code(8), wire::ErrorCode::future_tick);
  gate.settle(first, now);
  EXPECT_EQ(code(7), wire::ErrorCode::duplicate_tick);
  gate.await(first, now);
  gate.miss(first, now);
  EXPECT_EQ(code(7), wire::ErrorCode::stale_tick);
}

}  // namespace
}  // namespace ziggurat::network
