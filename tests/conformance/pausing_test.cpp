// SPDX-License-Identifier: MIT
// The rules of docs/protocol.md on pausing (section 3.3) and reset (L6). A test is named after the
// rule it holds.

#include <gtest/gtest.h>

#include "network/barrier/overview.h"
#include "pair.h"
#include "rules.h"

namespace ziggurat::network {
namespace {

using scene::DeadlineAction;
using std::chrono::milliseconds;
using Membership = RobotStatus::Membership;

TEST(Pause, P1_TakesEffectWhenTheLastThatOwesIsClosedForItsMessages) {
  Pair pair{Config{}};
  pair.peers.say("p", Peers::leave({0}));  // it still owes its answer
  pause(pair.peers.barrier);
  EXPECT_FALSE(pair.peers.barrier.gate.is_halted());
  for (unsigned i = 0; i <= Config{}.max_faults; ++i) pair.peers.send_bytes("p", "\xff");
  EXPECT_EQ(pair.peers.barrier.sessions.size(), 1U);
  pair.peers.pass(milliseconds{1});
  EXPECT_TRUE(pair.peers.barrier.gate.is_halted());
}

TEST(Pause, P1_AWorldWithoutRobotsStandsAtEachTick) {
  const SmallRun small(0);
  Peers peers(small);
  peers.publish(5);
  pause(peers.barrier);
  EXPECT_TRUE(peers.barrier.gate.is_halted());
  restart(peers.barrier, {42});
  peers.publish(0);
  EXPECT_TRUE(peers.barrier.gate.is_halted());
  EXPECT_FALSE(peers.is_complete());
}

TEST(Pause, V19_WhatTheWorldNeedsOfASessionThatAPauseHoldsUp) {
  Pair pair{Config{}};
  EXPECT_EQ(need_of(pair.peers.barrier, {"robot0"}), Need::answer);
  EXPECT_EQ(need_of(pair.peers.barrier, {"robot1"}), Need::answers);
  EXPECT_EQ(need_of(pair.peers.barrier, {"robot1", "robot0"}), Need::answer);
  EXPECT_EQ(need_of(pair.peers.barrier, {"nobody"}), Need::nothing);
  EXPECT_EQ(need_of(pair.peers.barrier, {}), Need::nothing);
  Pair late{with_deadline(DeadlineAction::hold, 50)};
  EXPECT_EQ(need_of(late.peers.barrier, {"robot0"}), Need::nothing);  // its deadline ends the wait
}

TEST(Pause, P2_BeforeTheFirstTickNoSessionIsTold) {
  const SmallRun small(1);
  Peers peers(small);
  pause(peers.barrier);
  peers.join("p", "*");
  EXPECT_TRUE(peers.inboxes["p"].empty());
  EXPECT_TRUE(peers.is_gathered());
  peers.publish(0);
  peers.inboxes.clear();
  peers.say("p", Peers::command(0));
  EXPECT_TRUE(peers.told("p").has_paused());
}

TEST(Pause, P3_NoDeadlineRunsAndHeartbeatsGoOn) {
  Config config = with_deadline(DeadlineAction::drop, 50);
  config.heartbeat = milliseconds{1000};
  Pair pair(config);
  pause(pair.peers.barrier);
  pair.peers.say("p", Peers::command(5));
  pair.peers.unreachable.insert("q");
  pair.peers.probe();  // robot1 is free
  pair.peers.inboxes.clear();
  for (int i = 0; i < 20; ++i) pair.peers.pass(milliseconds{1000});
  EXPECT_EQ(pair.peers.inboxes["p"].size(), 20U);
  EXPECT_TRUE(pair.peers.inboxes["p"].front().has_heartbeat());
  EXPECT_EQ(pair.peers.status()[1].membership, Membership::free);
  resume(pair.peers.barrier);
  pair.peers.pass(milliseconds{49});
  EXPECT_FALSE(pair.peers.is_complete()) << "it has its whole deadline from here";
  pair.peers.pass(milliseconds{1});
  EXPECT_EQ(pair.peers.status()[1].membership, Membership::gone);
  EXPECT_TRUE(pair.peers.is_complete());
}

TEST(Reset, L6_ASessionBeforeTick0GetsNoTickOfTheFormerWorld) {
  Pair pair({});
  restart(pair.peers.barrier, {7});
  pair.peers.say("r", takeover("robot0"));
  EXPECT_TRUE(pair.peers.told("r").has_welcome());  // and nothing else
  EXPECT_EQ(pair.peers.inboxes["p"].back().message_case(), v1::ServerMessage::kDisplaced);
  pair.peers.publish(0);
  EXPECT_EQ(pair.peers.told("r").observation().tick(), 0U);
  pair.peers.say("r", Peers::command(0, {1}));
  pair.peers.say("q", Peers::command(0));
  EXPECT_TRUE(pair.peers.is_complete());
}

}  // namespace
}  // namespace ziggurat::network
