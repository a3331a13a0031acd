// The rules of docs/protocol.md on deadlines, pausing, leases, takeover and rates. A test is named
// after the rule it holds.

#include <gtest/gtest.h>

#include "network/peers.h"

namespace ziggurat::network {
namespace {

using scene::DeadlineAction;
using std::chrono::milliseconds;
using Membership = RobotStatus::Membership;

/// All controllers have this policy, and nobody may change it.
Config with_deadline(DeadlineAction action, std::uint32_t ms, std::uint32_t budget = 0) {
  Config config;
  config.deadlines.assign(2, {{action, ms, budget}, true});
  config.heartbeat = milliseconds{100'000};  // out of the way
  return config;
}

v1::ClientMessage wish(const std::string& robots, v1::DeadlinePolicy::Action action,
                       std::uint32_t ms, std::uint32_t budget = 0) {
  auto hello = Peers::hello(robots);
  auto& policy = *hello.mutable_hello()->mutable_deadline_policy();
  policy.set_action(action);
  policy.set_wall_deadline_ms(ms);
  policy.set_miss_budget(budget);
  return hello;
}

v1::ClientMessage with_token(const std::string& token, bool takeover = false) {
  auto hello = Peers::hello("*");
  hello.mutable_hello()->set_session_token(token);
  hello.mutable_hello()->set_takeover(takeover);
  return hello;
}

v1::ClientMessage takeover(const std::string& robots) {
  auto hello = Peers::hello(robots);
  hello.mutable_hello()->set_client_name("usurper");
  hello.mutable_hello()->set_takeover(true);
  return hello;
}

/// "p" holds robot0 and owes tick 5, having commanded 3 before; "q" holds robot1 and has answered.
struct Pair {
  explicit Pair(const Config& config) : small(2), peers(small, config) {
    peers.join("p", "robot0");
    peers.join("q", "robot1");
    tick(4, {3});
    peers.publish(5);
    peers.say("q", Peers::command(5, {7}));
    peers.inboxes.clear();
  }
  void tick(std::uint64_t number, std::vector<double> targets = {}) {
    peers.publish(number);
    peers.say("p", Peers::command(number, std::move(targets)));
    peers.say("q", Peers::command(number));
  }
  double target() {
    peers.barrier.zero_missing(peers.commands);
    return peers.commands.joint_targets[0];
  }
  /// "p" is silent at the tick in hand, and a new one begins for both.
  void miss_and_go_on(std::uint64_t next) {
    peers.pass(milliseconds{50});
    EXPECT_TRUE(peers.barrier.complete()) << next;
    peers.publish(next);
    peers.say("q", Peers::command(next));
  }
  SmallRun small;
  Peers peers;
};

// ---- deadlines ----------------------------------------------------------------------------------

TEST(Deadline, HoldKeepsWhatWasCommanded) {
  Pair pair(with_deadline(DeadlineAction::hold, 50));
  pair.peers.pass(milliseconds{49});
  EXPECT_FALSE(pair.peers.barrier.complete());
  pair.peers.pass(milliseconds{1});
  EXPECT_TRUE(pair.peers.barrier.complete());
  EXPECT_EQ(pair.target(), 3);
  EXPECT_EQ(pair.peers.barrier.missed_ticks(), (std::vector<std::uint64_t>{1, 0}));
}

TEST(Deadline, ZeroStopsTheRobotUntilItIsCommandedAnew) {
  Pair pair(with_deadline(DeadlineAction::zero, 50));
  pair.peers.pass(milliseconds{50});
  EXPECT_TRUE(pair.peers.barrier.complete());
  EXPECT_EQ(pair.target(), 0);
  EXPECT_EQ(pair.peers.commands.joint_targets[1], 7);
  pair.tick(6);
  EXPECT_EQ(pair.target(), 0) << "W7";
  pair.tick(7, {2});
  EXPECT_EQ(pair.target(), 2);
}

TEST(Deadline, DropTakesTheRobotsOutForGood) {
  Pair pair(with_deadline(DeadlineAction::drop, 50));
  pair.peers.pass(milliseconds{50});
  EXPECT_TRUE(pair.peers.barrier.complete());
  EXPECT_EQ(pair.target(), 0);
  EXPECT_EQ(pair.peers.barrier.status()[0].membership, Membership::gone);
  EXPECT_EQ(pair.peers.told("p").error().code(), v1::Error::DEADLINE_MISSED);
  pair.peers.publish(6);
  EXPECT_TRUE(pair.peers.inboxes["p"].empty()) << "L3";
}

TEST(Deadline, DropHoldsTheBudgetFirst) {
  Pair pair(with_deadline(DeadlineAction::drop, 50, 2));
  pair.miss_and_go_on(6);
  pair.miss_and_go_on(7);
  EXPECT_EQ(pair.target(), 3);
  EXPECT_EQ(pair.peers.barrier.status()[0].membership, Membership::held);
  pair.peers.pass(milliseconds{50});
  EXPECT_EQ(pair.peers.barrier.status()[0].membership, Membership::gone);
}

TEST(Deadline, DropIsReportedWhateverNoiseStrangersMake) {
  Pair pair(with_deadline(DeadlineAction::drop, 50));
  for (int i = 0; i < 500; ++i) pair.peers.say_bytes("stranger", "\xff");
  pair.peers.pass(milliseconds{50});
  for (int i = 0; i < 500; ++i) pair.peers.say_bytes("stranger", "\xff");
  const auto dropped = pair.peers.barrier.take_report().dropped;
  ASSERT_EQ(dropped.size(), 1U);
  EXPECT_NE(dropped[0].find("robot0"), std::string::npos);
  EXPECT_TRUE(pair.peers.barrier.take_report().dropped.empty());
}

TEST(Deadline, HoldDropsBeyondTheBudget) {
  for (const auto action : {DeadlineAction::hold, DeadlineAction::zero}) {
    Pair pair(with_deadline(action, 50, 2));
    pair.miss_and_go_on(6);
    pair.miss_and_go_on(7);
    EXPECT_EQ(pair.peers.barrier.status()[0].membership, Membership::held);
    pair.peers.pass(milliseconds{50});
    EXPECT_EQ(pair.peers.barrier.status()[0].membership, Membership::gone);
  }
}

TEST(Deadline, StopEndsTheRunWithASentence) {
  Pair pair(with_deadline(DeadlineAction::stop, 50, 1));
  pair.miss_and_go_on(6);
  EXPECT_TRUE(pair.peers.barrier.take_report().stopped.empty());
  pair.peers.pass(milliseconds{50});
  EXPECT_FALSE(pair.peers.barrier.complete());
  const auto stopped = pair.peers.barrier.take_report().stopped;
  EXPECT_NE(stopped.find("'lua'"), std::string::npos) << stopped;
  EXPECT_NE(stopped.find("robot0"), std::string::npos);
  EXPECT_NE(stopped.find("tick 6"), std::string::npos);
  EXPECT_NE(stopped.find("stop:50:1"), std::string::npos);
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
  EXPECT_FALSE(peers.barrier.complete());
  peers.pass(milliseconds{1});
  EXPECT_TRUE(peers.barrier.complete());
  peers.barrier.zero_missing(peers.commands);
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
  EXPECT_FALSE(peers.barrier.complete());
  peers.say("p", Peers::leave({1}));  // the one that waits
  peers.pass(milliseconds{1});
  EXPECT_TRUE(peers.barrier.complete());
}

TEST(Deadline, W1_ASessionWhoseRobotsHaveAllLeftIsNotLateForThat) {
  for (const bool waits : {true, false}) {
    const auto action = waits ? DeadlineAction::wait : DeadlineAction::hold;
    Pair pair(with_deadline(action, 50));
    pair.peers.say("p", Peers::leave({0}));
    pair.peers.pass(milliseconds{49});
    EXPECT_FALSE(pair.peers.barrier.complete()) << "L2: it still owes its Command";
    EXPECT_TRUE(pair.peers.inboxes["p"].empty());
    pair.peers.pass(milliseconds{1});
    EXPECT_EQ(pair.peers.barrier.complete(), !waits);
    if (waits) pair.peers.say("p", Peers::command(5));
    EXPECT_TRUE(pair.peers.barrier.complete());
  }
}

TEST(Deadline, W2_ADeadConnectionIsUnderTheSamePolicy) {
  Pair pair(with_deadline(DeadlineAction::hold, 50));
  pair.peers.unreachable.insert("p");
  pair.peers.pass(milliseconds{50});  // it is told of its miss, and so found dead
  EXPECT_TRUE(pair.peers.barrier.complete() || pair.peers.barrier.status()[0].awaited);
  pair.peers.pass(milliseconds{50});
  EXPECT_TRUE(pair.peers.barrier.complete());
  pair.peers.publish(6);
  pair.peers.say("q", Peers::command(6));
  pair.peers.pass(milliseconds{0});
  EXPECT_TRUE(pair.peers.barrier.complete()) << "nobody waits for it any more";
  EXPECT_EQ(pair.target(), 3);
  // Somebody comes: the tick in hand waits again, and the robot obeys.
  pair.peers.publish(7);
  pair.peers.say("q", Peers::command(7));
  pair.peers.join("heir", "robot0");
  EXPECT_FALSE(pair.peers.barrier.complete());
  pair.peers.say("heir", Peers::command(7, {9}));
  EXPECT_TRUE(pair.peers.barrier.complete());
  EXPECT_EQ(pair.target(), 9);
}

TEST(Deadline, W3_TheBeginningWaitsForEver) {
  const SmallRun small(2);
  Peers peers(small, with_deadline(DeadlineAction::drop, 50));
  peers.join("p", "robot0");
  peers.pass(milliseconds{10'000});
  EXPECT_FALSE(peers.barrier.gathered());
  EXPECT_EQ(peers.barrier.status()[1].membership, Membership::free);
}

TEST(Deadline, W4_AnAnswerSetsTheBudgetBack) {
  Pair pair(with_deadline(DeadlineAction::drop, 50, 1));
  pair.peers.pass(milliseconds{50});
  pair.tick(6);
  pair.peers.publish(7);
  pair.peers.say("q", Peers::command(7));
  pair.peers.pass(milliseconds{50});
  EXPECT_EQ(pair.peers.barrier.status()[0].membership, Membership::held);
  EXPECT_EQ(pair.peers.barrier.missed_ticks()[0], 2U);
}

TEST(Deadline, W5_TheSessionIsToldAndGetsWhatFollows) {
  Pair pair(with_deadline(DeadlineAction::hold, 50));
  pair.peers.pass(milliseconds{50});
  const auto error = pair.peers.told("p").error();
  EXPECT_EQ(error.code(), v1::Error::DEADLINE_MISSED);
  EXPECT_EQ(error.severity(), v1::Error::WARNING);
  EXPECT_EQ(error.tick(), 5U);
  pair.peers.publish(6);
  EXPECT_EQ(pair.peers.told("p").observation().tick(), 6U);
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
  EXPECT_EQ(pair.peers.barrier.status()[0].membership, Membership::held);
}

TEST(Deadline, W6_AlsoWhileTheTickIsInHand) {
  Config config = with_deadline(DeadlineAction::hold, 50);
  config.deadlines.pop_back();
  Pair pair(config);
  pair.peers.publish(6);
  pair.peers.pass(milliseconds{50});
  EXPECT_FALSE(pair.peers.barrier.complete()) << "q waits for ever";
  pair.peers.inboxes.clear();
  pair.peers.say("p", Peers::command(6, {99}));
  EXPECT_EQ(pair.peers.told("p").error().code(), v1::Error::STALE_TICK);
}

TEST(Deadline, W8_AFullQueueIsAMissOrALoss) {
  Pair held(with_deadline(DeadlineAction::hold, 50));
  held.peers.say("p", Peers::command(5));
  held.peers.congested.insert("p");
  held.peers.publish(6);
  EXPECT_EQ(held.peers.barrier.status()[0].membership, Membership::held);
  held.peers.say("q", Peers::command(6));
  held.peers.pass(milliseconds{50});
  EXPECT_TRUE(held.peers.barrier.complete());
  Pair waited{Config{}};
  waited.peers.say("p", Peers::command(5));
  waited.peers.congested.insert("p");
  waited.peers.publish(6);
  EXPECT_EQ(waited.peers.barrier.status()[0].membership, Membership::free);
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

TEST(Deadline, H15_AWishThatIsNeverGrantedIsToldBeforeATakenRobot) {
  const SmallRun small(1);
  Peers peers(small, with_deadline(DeadlineAction::hold, 50));
  peers.join("p", "robot0");
  peers.say("q", wish("robot0", v1::DeadlinePolicy::WAIT, 0));
  const auto error = peers.told("q").refusal().error();
  EXPECT_EQ(error.code(), v1::Error::FORBIDDEN);
  EXPECT_FALSE(error.retryable());
}

TEST(Deadline, H8_PoliciesThatMakeNoSense) {
  const SmallRun small(1);
  Peers peers(small);
  peers.say("p", wish("*", v1::DeadlinePolicy::HOLD, 0));
  EXPECT_EQ(peers.told("p").refusal().error().code(), v1::Error::BAD_VALUE);
  for (const int action : {6, -1, 1'000'000}) {
    peers.say("p", wish("*", static_cast<v1::DeadlinePolicy::Action>(action), 10));
    EXPECT_EQ(peers.told("p").refusal().error().code(), v1::Error::BAD_VALUE) << action;
  }
  peers.say("p", wish("*", v1::DeadlinePolicy::ACTION_UNSPECIFIED, 0));
  EXPECT_EQ(peers.told("p").welcome().deadline_policy().action(), v1::DeadlinePolicy::WAIT);
}

// ---- pausing ------------------------------------------------------------------------------------

TEST(Pause, P1_TakesEffectWhenTheTickIsAnswered) {
  Pair pair{Config{}};
  pair.peers.barrier.pause();
  EXPECT_TRUE(pair.peers.inboxes.empty());
  EXPECT_FALSE(pair.peers.barrier.standing());
  pair.peers.say("p", Peers::command(5, {1}));
  EXPECT_FALSE(pair.peers.barrier.complete());
  EXPECT_TRUE(pair.peers.barrier.standing());
  EXPECT_EQ(pair.peers.commands.joint_targets[0], 1);
  for (const auto* peer : {"p", "q"}) {
    const auto told = pair.peers.told(peer);
    ASSERT_TRUE(told.has_paused());
    EXPECT_EQ(told.paused().tick(), 5U);
  }
  pair.peers.barrier.resume();
  EXPECT_TRUE(pair.peers.barrier.complete());
  pair.tick(6);
  EXPECT_TRUE(pair.peers.barrier.complete());
}

TEST(Pause, P2_WhoComesMeanwhileIsToldAfterItsAnswer) {
  Pair pair{Config{}};
  pair.peers.say("p", Peers::command(5));
  pair.peers.barrier.pause();
  pair.peers.say("p", Peers::leave({}));
  pair.peers.unreachable.insert("q");
  pair.peers.probe();
  pair.peers.unreachable.clear();
  pair.peers.inboxes.clear();
  pair.peers.say("late", Peers::hello("robot1"));
  ASSERT_EQ(pair.peers.inboxes["late"].size(), 2U);
  EXPECT_EQ(pair.peers.inboxes["late"][1].observation().tick(), 5U);
  pair.peers.inboxes.clear();
  pair.peers.say("late", Peers::command(5, {8}));
  EXPECT_EQ(pair.peers.told("late").paused().tick(), 5U);
  EXPECT_EQ(pair.peers.commands.joint_targets[1], 8);
  pair.peers.barrier.resume();
  EXPECT_TRUE(pair.peers.barrier.complete());
}

TEST(Pause, P2_BeforeTheFirstTickNobodyIsTold) {
  const SmallRun small(1);
  Peers peers(small);
  peers.barrier.pause();
  peers.join("p", "*");
  EXPECT_TRUE(peers.inboxes["p"].empty());
  EXPECT_TRUE(peers.barrier.gathered());
  peers.publish(0);
  peers.inboxes.clear();
  peers.say("p", Peers::command(0));
  EXPECT_TRUE(peers.told("p").has_paused());
}

TEST(Pause, P3_NoDeadlineRunsAndHeartbeatsGoOn) {
  Config config = with_deadline(DeadlineAction::drop, 50);
  config.heartbeat = milliseconds{1000};
  Pair pair(config);
  pair.peers.barrier.pause();
  pair.peers.say("p", Peers::command(5));
  pair.peers.unreachable.insert("q");
  pair.peers.probe();  // robot1 is nobody's
  pair.peers.inboxes.clear();
  for (int i = 0; i < 20; ++i) pair.peers.pass(milliseconds{1000});
  EXPECT_EQ(pair.peers.inboxes["p"].size(), 20U);
  EXPECT_TRUE(pair.peers.inboxes["p"].front().has_heartbeat());
  EXPECT_EQ(pair.peers.barrier.status()[1].membership, Membership::free);
  pair.peers.barrier.resume();
  pair.peers.pass(milliseconds{49});
  EXPECT_FALSE(pair.peers.barrier.complete()) << "it has its whole deadline from here";
  pair.peers.pass(milliseconds{1});
  EXPECT_EQ(pair.peers.barrier.status()[1].membership, Membership::gone);
  EXPECT_TRUE(pair.peers.barrier.complete());
}

// ---- heartbeats and rates -----------------------------------------------------------------------

TEST(Heartbeat, M6_WhateverTheSessionWaitsFor) {
  const SmallRun small(2);
  Peers peers(small);
  EXPECT_EQ(peers.join("p", "robot0").wall_heartbeat_ms(), 1000U);
  const auto beats = [&] {
    int count = 0;
    for (const auto& message : std::exchange(peers.inboxes["p"], {})) {
      count += message.has_heartbeat() ? 1 : 0;
    }
    return count;
  };
  for (int i = 0; i < 100; ++i) peers.pass(milliseconds{100});
  EXPECT_EQ(beats(), 10) << "ready";
  peers.join("q", "robot1");
  peers.publish(0);
  peers.say("p", Peers::command(0));
  beats();
  for (int i = 0; i < 100; ++i) peers.pass(milliseconds{100});
  EXPECT_EQ(beats(), 10) << "others are slow";
}

TEST(Heartbeat, M6_WhoComputesForANightFindsFewOfThem) {
  const SmallRun small(1);
  Peers peers(small);
  peers.join("p", "*");
  peers.publish(0);
  peers.inboxes.clear();
  for (int i = 0; i < 3600; ++i) peers.pass(milliseconds{1000});
  const auto count = peers.inboxes["p"].size();
  EXPECT_GE(count, 60U + 58U);  // one a second for a minute, then one a minute
  EXPECT_LE(count, 60U + 60U);
}

TEST(Heartbeat, M6_MessagesTakeTheirPlace) {
  const SmallRun small(1);
  Peers peers(small);
  peers.join("p", "*");
  for (std::uint64_t tick = 0; tick < 10; ++tick) {
    peers.pass(milliseconds{400});
    peers.publish(tick);
    peers.pass(milliseconds{400});
    peers.say("p", Peers::command(tick));
  }
  for (const auto& message : peers.inboxes["p"]) EXPECT_FALSE(message.has_heartbeat());
}

TEST(Rate, M7_AFloodIsToldOnceAndThrownOut) {
  Pair pair{Config{}};
  for (int i = 0; i < 5000; ++i) pair.peers.say("p", Peers::heartbeat(1));
  const auto& told = pair.peers.inboxes["p"];
  ASSERT_LE(told.size(), 2001U);
  ASSERT_GE(told.size(), 1900U);
  EXPECT_EQ(told.back().error().code(), v1::Error::TOO_MANY);
  EXPECT_EQ(told.back().error().severity(), v1::Error::FATAL);
  EXPECT_EQ(pair.peers.barrier.status()[0].membership, Membership::free);
  pair.peers.inboxes.clear();
  pair.peers.say("p", Peers::hello("robot0"));
  EXPECT_TRUE(pair.peers.inboxes["p"].empty()) << "not answered while it floods";
  pair.peers.pass(milliseconds{10});
  pair.peers.inboxes.clear();
  pair.peers.say("p", Peers::hello("robot0"));
  EXPECT_TRUE(pair.peers.inboxes["p"].front().has_welcome());
}

TEST(Rate, M7_AnswersThatAreDueAreFree) {
  Pair pair{Config{}};
  pair.peers.say("p", Peers::command(5));
  for (std::uint64_t tick = 6; tick < 20'000; ++tick) {
    pair.tick(tick);
    pair.peers.inboxes.clear();
    ASSERT_TRUE(pair.peers.barrier.complete());
  }
}

TEST(Rate, M7_StrangersToo) {
  const SmallRun small(1);
  Peers peers(small);
  for (int i = 0; i < 5000; ++i) peers.say_bytes("stranger", "garbage");
  EXPECT_LE(peers.inboxes["stranger"].size(), 2001U);
  EXPECT_TRUE(peers.join("p", "*").robots_size() == 1) << "nobody else is concerned";
}

// ---- leases, takeover, resuming -----------------------------------------------------------------

struct Lease : ::testing::Test {
  Lease() : small(2), peers(small, config()) {
    token = peers.join("old", "robot0").session_token();
    peers.join("q", "robot1");
    peers.publish(3);
    peers.say("q", Peers::command(3));
    peers.unreachable.insert("old");
    peers.probe();
    peers.inboxes.clear();
  }
  static Config config() {
    Config config;
    config.lease = milliseconds{10'000};
    return config;
  }
  SmallRun small;
  Peers peers;
  std::string token;
};

TEST_F(Lease, L7_KeepsTheRobotsForTheToken) {
  peers.pass(milliseconds{4'000});
  peers.say("new", Peers::hello("robot0"));
  const auto refusal = peers.told("new").refusal();
  EXPECT_EQ(refusal.error().code(), v1::Error::ROBOT_TAKEN);
  EXPECT_TRUE(refusal.error().retryable());
  EXPECT_EQ(refusal.holder(), "tester");
  EXPECT_NE(refusal.error().message().find("6.0 s"), std::string::npos)
      << refusal.error().message();
  peers.say("back", with_token(token));
  ASSERT_EQ(peers.inboxes["back"].size(), 2U);
  EXPECT_EQ(peers.inboxes["back"][0].welcome().session_token(), token);
  EXPECT_EQ(peers.inboxes["back"][0].welcome().wall_lease_ms(), 10'000U);
  EXPECT_EQ(peers.inboxes["back"][1].observation().tick(), 3U);
  EXPECT_FALSE(peers.barrier.complete());
  peers.say("back", Peers::command(3, {4}));
  EXPECT_TRUE(peers.barrier.complete());
  EXPECT_EQ(peers.commands.joint_targets[0], 4);
}

TEST_F(Lease, L7_EndsWithTime) {
  peers.pass(milliseconds{10'000});
  EXPECT_EQ(peers.join("new", "robot0").robots_size() + 0, 0) << "Observation follows Welcome";
  EXPECT_EQ(peers.barrier.status()[0].membership, Membership::held);
  peers.say("back", with_token(token));
  EXPECT_EQ(peers.told("back").refusal().error().code(), v1::Error::NO_SUCH_SESSION);
}

TEST_F(Lease, L7_TheTokenIsGoodAfterItAsLongAsNobodyCame) {
  peers.pass(milliseconds{100'000});
  peers.inboxes.clear();
  peers.say("back", with_token(token));
  EXPECT_TRUE(peers.inboxes["back"].front().has_welcome());
}

TEST_F(Lease, L7_TakeoverEndsIt) {
  peers.say("new", takeover("robot0"));
  EXPECT_TRUE(peers.inboxes["new"].front().has_welcome());
  peers.say("back", with_token(token));
  EXPECT_EQ(peers.told("back").refusal().error().code(), v1::Error::NO_SUCH_SESSION);
}

TEST(Resume, L9_AnAnswerOfBeforeIsReplacedNotRepeated) {
  SmallRun small(1);
  small.layout().robots[0].radios = {0, 1};
  small.layout().radios.resize(1);
  small.layout().radios[0].sends = true;
  Peers peers(small);
  const std::string token = peers.join("old", "*").session_token();
  peers.publish(3);
  auto command = Peers::command(3, {5});
  command.mutable_command()->add_radio_messages()->set_payload("once");
  peers.say("old", command);
  EXPECT_TRUE(peers.barrier.complete());
  peers.unreachable.insert("old");
  peers.probe();
  peers.say("back", with_token(token));
  peers.say("back", command);
  EXPECT_TRUE(peers.barrier.complete());
  EXPECT_EQ(peers.commands.radio_messages.entries.size(), 1U);
  peers.inboxes.clear();
  peers.say("back", command);
  EXPECT_EQ(peers.told("back").error().code(), v1::Error::DUPLICATE_TICK);
}

TEST(Takeover, H13_TheHolderIsToldAndClosed) {
  const SmallRun small(4);
  Peers peers(small);
  peers.join("p", "robot[01]");
  peers.join("q", "robot[23]");
  peers.publish(2);
  peers.inboxes.clear();
  peers.say("new", takeover("robot[12]"));
  EXPECT_EQ(peers.told("p").displaced().by(), "usurper");
  EXPECT_EQ(peers.told("q").displaced().by(), "usurper");
  ASSERT_EQ(peers.inboxes["new"].size(), 2U);
  const auto status = peers.barrier.status();
  EXPECT_EQ(status[0].membership, Membership::free);
  EXPECT_EQ(status[1].holder, "usurper");
  EXPECT_EQ(status[2].holder, "usurper");
  EXPECT_EQ(status[3].membership, Membership::free);
  peers.say("p", Peers::command(2, {9, 9}));
  EXPECT_EQ(peers.told("p").error().code(), v1::Error::OUT_OF_STATE);
  EXPECT_EQ(peers.commands.joint_targets[0], 0);
  peers.say("new", Peers::command(2));
  peers.join("heir", "robot[03]");
  EXPECT_FALSE(peers.barrier.complete());
  peers.say("heir", Peers::command(2));
  EXPECT_TRUE(peers.barrier.complete());
}

TEST(Takeover, H13_ARefusedOneDisplacesNobody) {
  const SmallRun small(2);
  Config config;
  config.deadlines = {{{}, true}};
  Peers peers(small, config);
  peers.join("p", "robot0");
  peers.join("q", "robot1");
  auto hello = takeover("robot0");
  hello.mutable_hello()->add_robots("nobody");
  peers.say("new", hello);
  EXPECT_EQ(peers.told("new").refusal().error().code(), v1::Error::UNKNOWN_ROBOT);
  hello = wish("*", v1::DeadlinePolicy::HOLD, 10);
  hello.mutable_hello()->set_takeover(true);
  peers.say("new", hello);
  EXPECT_EQ(peers.told("new").refusal().error().code(), v1::Error::FORBIDDEN);
  peers.say("q", Peers::leave());
  hello = takeover("robot0");
  hello.mutable_hello()->add_robots("robot1");
  peers.say("new", hello);
  EXPECT_EQ(peers.told("new").refusal().error().code(), v1::Error::NOT_YOURS);
  EXPECT_TRUE(peers.inboxes["p"].empty());
  EXPECT_EQ(peers.barrier.status()[0].holder, "tester");
}

TEST(Takeover, L8_OfAConnectedSessionByItsToken) {
  const SmallRun small(2);
  Peers peers(small);
  const std::string token = peers.join("old", "*").session_token();
  peers.publish(1);
  peers.inboxes.clear();
  peers.say("new", with_token(token));
  EXPECT_EQ(peers.told("new").refusal().error().code(), v1::Error::ROBOT_TAKEN);
  peers.inboxes.clear();
  peers.say("new", with_token(token, true));
  EXPECT_TRUE(peers.inboxes["old"].back().has_displaced());
  ASSERT_EQ(peers.inboxes["new"].size(), 2U);
  EXPECT_EQ(peers.inboxes["new"][0].welcome().session_token(), token);
  peers.say("new", Peers::command(1));
  EXPECT_TRUE(peers.barrier.complete());
}

TEST(Takeover, L10_ADisplacedTokenIsGoodForNothing) {
  const SmallRun small(2);
  Peers peers(small);
  const std::string token = peers.join("old", "*").session_token();
  peers.say("new", takeover("robot0"));
  peers.say("new", Peers::leave());
  peers.inboxes.clear();
  peers.say("old", with_token(token));
  EXPECT_EQ(peers.told("old").refusal().error().code(), v1::Error::NO_SUCH_SESSION);
}

TEST(Reset, L6_WhoComesBeforeTick0GetsNoTickOfTheWorldThatWas) {
  Pair pair({});
  pair.peers.barrier.reset(7);
  pair.peers.say("r", takeover("robot0"));
  EXPECT_TRUE(pair.peers.told("r").has_welcome());  // and nothing else
  EXPECT_EQ(pair.peers.inboxes["p"].back().message_case(), v1::ServerMessage::kDisplaced);
  pair.peers.publish(0);
  EXPECT_EQ(pair.peers.told("r").observation().tick(), 0U);
  pair.peers.say("r", Peers::command(0, {1}));
  pair.peers.say("q", Peers::command(0));
  EXPECT_TRUE(pair.peers.barrier.complete());
}

TEST(Sessions, ThousandsComeAndGo) {
  const SmallRun small(3);
  Config config;
  config.max_sessions = 4;
  config.lease = milliseconds{1};
  Peers peers(small, config);
  peers.publish(0);
  for (int i = 0; i < 20'000; ++i) {
    const std::string peer = "peer" + std::to_string(i);
    peers.say(peer, Peers::hello("robot" + std::to_string(i % 3)));
    ASSERT_TRUE(peers.inboxes[peer].front().has_welcome()) << i;
    peers.unreachable = {peer};
    peers.probe();
    peers.inboxes.clear();
  }
  EXPECT_LE(peers.barrier.known().sessions, 3U);
  EXPECT_LE(peers.barrier.known().peers, 8U);
}

}  // namespace
}  // namespace ziggurat::network
