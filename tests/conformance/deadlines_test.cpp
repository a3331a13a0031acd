// SPDX-License-Identifier: MIT
// The rules of docs/protocol.md on deadlines. A test is named after the rule it holds.

#include <gtest/gtest.h>

#include "pair.h"

namespace ziggurat::network {
namespace {

using scene::DeadlineAction;
using std::chrono::milliseconds;
using Membership = RobotStatus::Membership;

TEST(Deadline, DropIsReportedDespiteManyOtherNotices) {
  Pair pair(with_deadline(DeadlineAction::drop, 50));
  for (int i = 0; i < 500; ++i) pair.peers.send_bytes("unknown", "\xff");
  pair.peers.pass(milliseconds{50});
  for (int i = 0; i < 500; ++i) pair.peers.send_bytes("unknown", "\xff");
  const auto dropped = pair.peers.take_report().dropped;
  ASSERT_EQ(dropped.size(), 1U);
  EXPECT_NE(dropped[0].find("robot0"), std::string::npos);
  EXPECT_TRUE(pair.peers.take_report().dropped.empty());
}

TEST(Deadline, W1_TheLongestOfASessionCounts) {
  Config config;
  config.deadlines = {{{DeadlineAction::zero, 20, 0}, true}, {{DeadlineAction::hold, 60, 0}, true}};
  const SmallRun small(2);
  Peers peers(small, config);
  const auto welcome = peers.join("p", "*");
  EXPECT_FALSE(welcome.has_deadline_policy()) << "H14";
  EXPECT_EQ(welcome.robots(0).deadline_policy().action(), v1::DeadlinePolicy::ZERO);
  EXPECT_EQ(welcome.robots(1).deadline_policy().wall_deadline_ms(), 60U);
  peers.publish(0);
  peers.say("p", Peers::command(0, {3, 4}));
  peers.publish(1);
  peers.pass(milliseconds{59});
  EXPECT_FALSE(peers.is_complete());
  peers.pass(milliseconds{1});
  EXPECT_TRUE(peers.is_complete());
  zero_missing(peers.barrier, peers.commands);
  EXPECT_EQ(peers.commands.joint_targets, (std::vector<double>{0, 4}));
}

TEST(Deadline, W1_ASessionWithARobotThatWaitsNeverMisses) {
  Config config;
  config.deadlines = {{{DeadlineAction::zero, 20, 0}, true}};
  const SmallRun small(2);
  Peers peers(small, config);
  peers.join("p", "*");
  peers.publish(0);
  peers.pass(milliseconds{900'000});
  EXPECT_FALSE(peers.is_complete());
  peers.say("p", Peers::leave({1}));  // the one that waits
  peers.pass(milliseconds{1});
  EXPECT_TRUE(peers.is_complete());
}

TEST(Deadline, W1_ASessionWhoseRobotsHaveAllLeftIsNotLateForThat) {
  for (const bool waits : {true, false}) {
    const auto action = waits ? DeadlineAction::wait : DeadlineAction::hold;
    Pair pair(with_deadline(action, 50));
    pair.peers.say("p", Peers::leave({0}));
    pair.peers.pass(milliseconds{49});
    EXPECT_FALSE(pair.peers.is_complete()) << "L2: it still owes its Command";
    EXPECT_TRUE(pair.peers.inboxes["p"].empty());
    pair.peers.pass(milliseconds{1});
    EXPECT_EQ(pair.peers.is_complete(), !waits);
    if (waits) pair.peers.say("p", Peers::command(5));
    EXPECT_TRUE(pair.peers.is_complete());
  }
}

TEST(Deadline, W2_ATickThatWasMissedIsNotAwaitedOnceMoreWhenTheConnectionGoes) {
  Config config = with_deadline(DeadlineAction::stop, 50, 1);
  config.deadlines.pop_back();
  Pair pair(config);
  pair.peers.publish(6);
  pair.peers.pass(milliseconds{50});
  pair.peers.unreachable.insert("p");
  pair.peers.pass(milliseconds{100'000});  // a heartbeat finds it dead while q is waited for
  EXPECT_EQ(pair.peers.status()[0].membership, Membership::free);
  EXPECT_FALSE(pair.peers.status()[0].awaited);
  pair.peers.pass(milliseconds{50});
  EXPECT_TRUE(pair.peers.take_report().stopped.empty()) << "one miss is within the budget";
  pair.peers.say("q", Peers::command(6));
  EXPECT_TRUE(pair.peers.is_complete());
  pair.peers.publish(7);
  pair.peers.pass(milliseconds{0});
  EXPECT_FALSE(pair.peers.take_report().stopped.empty()) << "and two are not";
}

/// Clients take the robot one after the other and are gone before its deadline of 50 ms. A program
/// does so that crashes and is started again.
void crash_again_and_again(Pair& pair, int times) {
  for (int i = 0; i < times; ++i) {
    const std::string client = "crashes" + std::to_string(i);
    pair.peers.join(client, "robot0");
    pair.peers.pass(milliseconds{20});
    disconnect(pair.peers.barrier, client);
    pair.peers.pass(milliseconds{20});
  }
}

TEST(Deadline, W11_WhoCrashesAgainAndAgainHoldsATickForThreeDeadlines) {
  Pair pair(with_deadline(DeadlineAction::hold, 50));
  disconnect(pair.peers.barrier, "p");
  crash_again_and_again(pair, 3);  // 120 ms
  EXPECT_FALSE(pair.peers.is_complete());
  pair.peers.join("last", "robot0");
  pair.peers.pass(milliseconds{29});
  EXPECT_FALSE(pair.peers.is_complete());
  pair.peers.pass(milliseconds{1});
  EXPECT_TRUE(pair.peers.is_complete());
  EXPECT_EQ(pair.peers.told("last").error().code(), v1::Error::DEADLINE_MISSED) << "W5";
  pair.peers.publish(6);
  pair.peers.say("q", Peers::command(6));
  pair.peers.pass(milliseconds{49});
  EXPECT_FALSE(pair.peers.is_complete()) << "the next tick waits anew";
}

TEST(Deadline, W11_ResumingATickAgainAndAgainHoldsItForThreeDeadlines) {
  Pair pair(with_deadline(DeadlineAction::hold, 50));
  auto resume = Peers::hello("");
  resume.mutable_hello()->clear_robots();
  resume.mutable_hello()->set_session_token(
      pair.peers.barrier.sessions.find(pair.peers.barrier.ownership[0].holder)->token);
  for (int i = 0; i < 3; ++i) {  // over a new connection each time, as L8 allows
    pair.peers.pass(milliseconds{40});
    pair.peers.say("again" + std::to_string(i), resume);
  }
  pair.peers.pass(milliseconds{29});
  EXPECT_FALSE(pair.peers.is_complete());
  pair.peers.pass(milliseconds{1});
  EXPECT_TRUE(pair.peers.is_complete());
}

TEST(Deadline, W11_ATickThatWaitsForOthersDoesNotUseThatUp) {
  Config config = with_deadline(DeadlineAction::drop, 50);
  config.deadlines.pop_back();  // q waits forever
  Pair pair(config);
  pair.peers.say("p", Peers::command(5));
  pair.peers.publish(6);
  pair.peers.say("p", Peers::command(6));
  for (int i = 0; i < 5; ++i) {
    pair.peers.pass(milliseconds{1000});
    auto take = Peers::hello("robot0");
    take.mutable_hello()->set_takeover(true);
    const std::string client = "next" + std::to_string(i);
    pair.peers.say(client, take);
    pair.peers.pass(milliseconds{20});
    pair.peers.say(client, Peers::command(6));
  }
  pair.peers.pass(milliseconds{1000});
  EXPECT_EQ(pair.peers.status()[0].membership, Membership::held) << "five answers in time";
}

TEST(Deadline, W11_ARobotMissesATickOnceWhoeverHasIt) {
  Config config = with_deadline(DeadlineAction::drop, 50, 1);
  config.deadlines.pop_back();  // q waits forever
  Pair pair(config);
  pair.peers.say("p", Peers::command(5));
  pair.peers.publish(6);
  pair.peers.pass(milliseconds{50});
  disconnect(pair.peers.barrier, "p");
  pair.peers.join("heir", "robot0");
  pair.peers.pass(milliseconds{50});
  EXPECT_EQ(pair.peers.status()[0].membership, Membership::held) << "one miss is within the budget";
  pair.peers.say("q", Peers::command(6));
  pair.peers.publish(7);
  pair.peers.pass(milliseconds{50});
  EXPECT_EQ(pair.peers.status()[0].membership, Membership::gone);
}

TEST(Deadline, W6_LateCommandsAreStaleAndNoOffence) {
  Pair pair(with_deadline(DeadlineAction::hold, 50));
  for (std::uint64_t tick = 5; tick < 300; ++tick) {
    pair.miss_and_go_on(tick + 1);
    pair.peers.inboxes.clear();
    pair.peers.say("p", Peers::command(tick, {99}));
    const auto error = pair.peers.told("p").error();
    ASSERT_EQ(error.code(), v1::Error::STALE_TICK);
    ASSERT_EQ(error.severity(), v1::Error::DISCARD);
  }
  EXPECT_EQ(pair.target(), 3);
  EXPECT_EQ(pair.peers.status()[0].membership, Membership::held);
}

TEST(Deadline, W8_AFullQueueIsAMissOrALoss) {
  Pair held(with_deadline(DeadlineAction::hold, 50));
  held.peers.say("p", Peers::command(5));
  held.peers.congested.insert("p");
  held.peers.publish(6);
  EXPECT_EQ(held.peers.status()[0].membership, Membership::held);
  held.peers.say("q", Peers::command(6));
  held.peers.pass(milliseconds{50});
  EXPECT_TRUE(held.peers.is_complete());
  Pair waited{Config{}};
  waited.peers.say("p", Peers::command(5));
  waited.peers.congested.insert("p");
  waited.peers.publish(6);
  EXPECT_EQ(waited.peers.status()[0].membership, Membership::free);
}

TEST(Deadline, H8_AWishIsGrantedUnlessThePolicyIsFixed) {
  const SmallRun small(2);
  Config config;
  config.deadlines = {{}, {{DeadlineAction::drop, 70, 3}, true}};
  Peers peers(small, config);
  peers.say("p", wish("robot0", v1::DeadlinePolicy::HOLD, 40, 5));
  const auto policy = peers.told("p").welcome().deadline_policy();
  EXPECT_EQ(policy.action(), v1::DeadlinePolicy::HOLD);
  EXPECT_EQ(policy.wall_deadline_ms(), 40U);
  EXPECT_EQ(policy.miss_budget(), 5U);
  peers.say("q", wish("robot1", v1::DeadlinePolicy::HOLD, 40, 5));
  EXPECT_EQ(peers.told("q").refusal().error().code(), v1::Error::FORBIDDEN);
  peers.say("q", wish("robot1", v1::DeadlinePolicy::DROP, 70, 3));
  EXPECT_EQ(peers.told("q").welcome().deadline_policy().action(), v1::DeadlinePolicy::DROP);
}

}  // namespace
}  // namespace ziggurat::network
