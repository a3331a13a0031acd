// The rules of docs/protocol.md on pausing, heartbeats, rates, leases, takeover and reset. A test
// is named after the rule it holds.

#include <gtest/gtest.h>

#include "pair.h"

namespace ziggurat::network {
namespace {

using scene::DeadlineAction;
using std::chrono::milliseconds;
using Membership = RobotStatus::Membership;

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

// ---- pausing ------------------------------------------------------------------------------------

TEST(Pause, P1_TakesEffectWhenTheTickIsAnswered) {
  Pair pair{Config{}};
  pause(pair.peers.barrier);
  EXPECT_TRUE(pair.peers.inboxes.empty());
  EXPECT_FALSE(pair.peers.barrier.gate.is_standing());
  pair.peers.say("p", Peers::command(5, {1}));
  EXPECT_FALSE(pair.peers.is_complete());
  EXPECT_TRUE(pair.peers.barrier.gate.is_standing());
  EXPECT_EQ(pair.peers.commands.joint_targets[0], 1);
  for (const auto* peer : {"p", "q"}) {
    const auto told = pair.peers.told(peer);
    ASSERT_TRUE(told.has_paused());
    EXPECT_EQ(told.paused().tick(), 5U);
  }
  resume(pair.peers.barrier);
  EXPECT_TRUE(pair.peers.is_complete());
  pair.tick(6);
  EXPECT_TRUE(pair.peers.is_complete());
}

TEST(Pause, P2_ASessionThatBeginsMeanwhileIsToldAfterItsAnswer) {
  Pair pair{Config{}};
  pair.peers.say("p", Peers::command(5));
  pause(pair.peers.barrier);
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
  resume(pair.peers.barrier);
  EXPECT_TRUE(pair.peers.is_complete());
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

TEST(Heartbeat, M6_AClientThatComputesForANightFindsFewOfThem) {
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
  EXPECT_EQ(pair.peers.status()[0].membership, Membership::free);
  pair.peers.inboxes.clear();
  pair.peers.say("p", Peers::hello("robot0"));
  EXPECT_TRUE(pair.peers.inboxes["p"].empty()) << "not answered while it floods";
  pair.peers.pass(milliseconds{10});
  pair.peers.inboxes.clear();
  pair.peers.say("p", Peers::hello("robot0"));
  EXPECT_TRUE(pair.peers.inboxes["p"].front().has_welcome());
}

TEST(Rate, M7_ExpectedAnswersAreFree) {
  Pair pair{Config{}};
  pair.peers.say("p", Peers::command(5));
  for (std::uint64_t tick = 6; tick < 20'000; ++tick) {
    pair.tick(tick);
    pair.peers.inboxes.clear();
    ASSERT_TRUE(pair.peers.is_complete());
  }
}

TEST(Rate, M7_LongMessagesCountMoreThanOnce) {
  const SmallRun small(1);
  Peers peers(small);
  const std::string garbage(40 * 1024, '\xff');
  for (int i = 0; i < 1000; ++i) peers.send_bytes("unknown", garbage);
  EXPECT_LE(peers.inboxes["unknown"].size(), 2000U / 11 + 2);
  EXPECT_EQ(peers.inboxes["unknown"].back().error().code(), v1::Error::TOO_MANY);
}

TEST(Rate, M7_PeersWithoutASessionToo) {
  const SmallRun small(1);
  Peers peers(small);
  for (int i = 0; i < 5000; ++i) peers.send_bytes("unknown", "garbage");
  EXPECT_LE(peers.inboxes["unknown"].size(), 2001U);
  EXPECT_TRUE(peers.join("p", "*").robots_size() == 1) << "others are not affected";
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
  EXPECT_FALSE(peers.is_complete());
  peers.say("back", Peers::command(3, {4}));
  EXPECT_TRUE(peers.is_complete());
  EXPECT_EQ(peers.commands.joint_targets[0], 4);
}

TEST_F(Lease, L7_EndsWithTime) {
  peers.pass(milliseconds{10'000});
  EXPECT_EQ(peers.join("new", "robot0").robots_size() + 0, 0) << "Observation follows Welcome";
  EXPECT_EQ(peers.status()[0].membership, Membership::held);
  peers.say("back", with_token(token));
  EXPECT_EQ(peers.told("back").refusal().error().code(), v1::Error::NO_SUCH_SESSION);
}

TEST_F(Lease, L7_TheTokenStaysValidUntilAnotherSessionHasTheRobots) {
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
  EXPECT_TRUE(peers.is_complete());
  peers.unreachable.insert("old");
  peers.probe();
  peers.say("back", with_token(token));
  peers.say("back", command);
  EXPECT_TRUE(peers.is_complete());
  EXPECT_EQ(peers.commands.radio_messages.entries.size(), 1U);
  peers.inboxes.clear();
  peers.say("back", command);
  EXPECT_EQ(peers.told("back").error().code(), v1::Error::DUPLICATE_TICK);
}

TEST(Takeover, H13_AHolderWithoutRobotsLeftIsToldAndClosed) {
  const SmallRun small(4);
  Peers peers(small);
  peers.join("p", "robot[01]");
  peers.join("q", "robot[23]");
  peers.publish(2);
  peers.inboxes.clear();
  peers.say("new", takeover("*"));
  EXPECT_EQ(peers.told("p").displaced().by(), "usurper");
  EXPECT_EQ(peers.told("q").displaced().by(), "usurper");
  ASSERT_EQ(peers.inboxes["new"].size(), 2U);
  const auto status = peers.status();
  for (const auto& robot : status) EXPECT_EQ(robot.holder, "usurper");
  peers.say("p", Peers::command(2, {9, 9}));
  EXPECT_EQ(peers.told("p").error().code(), v1::Error::OUT_OF_STATE);
  EXPECT_EQ(peers.commands.joint_targets[0], 0);
  EXPECT_FALSE(peers.is_complete());
  peers.say("new", Peers::command(2));
  EXPECT_TRUE(peers.is_complete());
}

/// "p" holds robots 0 to 2 of four, "q" the last one; "new" takes over robots 2 and 3.
struct PartOfASession : testing::Test {
  PartOfASession() : small(4), peers(small) {
    token = peers.join("p", "robot[012]").session_token();
    peers.join("q", "robot3");
    peers.publish(2);
    peers.inboxes.clear();
  }
  void take() {
    peers.say("new", takeover("robot[23]"));
    ASSERT_EQ(peers.inboxes["new"].size(), 2U);
    EXPECT_TRUE(peers.inboxes["new"][1].has_observation());
  }
  SmallRun small;
  Peers peers;
  std::string token;
};

TEST_F(PartOfASession, H13_TheHolderKeepsTheRest) {
  take();
  EXPECT_EQ(peers.told("q").displaced().by(), "usurper");
  const auto told = peers.told("p").error();
  EXPECT_EQ(told.code(), v1::Error::NOT_YOURS);
  EXPECT_EQ(told.severity(), v1::Error::WARNING);
  EXPECT_EQ(told.robot(), "robot2");
  const auto status = peers.status();
  for (const std::size_t robot : {0, 1}) EXPECT_EQ(status[robot].holder, "tester");
  for (const std::size_t robot : {2, 3}) EXPECT_EQ(status[robot].holder, "usurper");
  peers.say("p", Peers::command(2, {1, 2, 9}));
  EXPECT_FALSE(peers.is_complete());
  peers.say("new", Peers::command(2, {3, 4}));
  EXPECT_TRUE(peers.is_complete());
  EXPECT_EQ(peers.commands.joint_targets, (std::vector<double>{1, 2, 3, 4}));
}

TEST_F(PartOfASession, H13_CommandsForRobotsThatWereTakenHaveNoEffect) {
  take();
  peers.say("new", Peers::command(2, {3, 4}));
  auto late = Peers::command(2, {1, 9});  // on its way when the robot was taken
  late.mutable_command()->add_robots(0);
  late.mutable_command()->add_robots(2);
  peers.inboxes.clear();
  peers.say("p", late);
  EXPECT_TRUE(peers.inboxes["p"].empty());
  EXPECT_TRUE(peers.is_complete());
  EXPECT_EQ(peers.commands.joint_targets, (std::vector<double>{1, 0, 3, 4}));
  peers.say("p", Peers::leave());
  EXPECT_EQ(peers.status()[2].holder, "usurper");
  EXPECT_EQ(peers.status()[3].holder, "usurper");
  peers.publish(3);
  peers.say("new", Peers::command(3, {5, 6}));
  EXPECT_TRUE(peers.is_complete());
}

TEST_F(PartOfASession, L10_ItsTokenStaysValidForTheRest) {
  take();
  peers.unreachable.insert("p");
  peers.probe();
  peers.inboxes.clear();
  peers.say("back", with_token(token));
  const auto& inbox = peers.inboxes["back"];
  ASSERT_EQ(inbox.size(), 3U);
  EXPECT_EQ(inbox[0].welcome().robots_size(), 3);
  EXPECT_EQ(inbox[1].error().code(), v1::Error::NOT_YOURS);
  EXPECT_EQ(inbox[1].error().robot(), "robot2");
  EXPECT_EQ(inbox[2].observation().tick(), 2U);
  peers.say("back", Peers::command(2, {1, 2, 9}));
  peers.say("new", Peers::command(2));
  EXPECT_TRUE(peers.is_complete());
  EXPECT_EQ(peers.commands.joint_targets[2], 0);
}

TEST_F(PartOfASession, L4_ALostOneKeepsTheRest) {
  peers.unreachable.insert("p");
  peers.probe();
  take();
  peers.say("back", with_token(token));
  EXPECT_TRUE(peers.inboxes["back"].front().has_welcome());
  EXPECT_EQ(peers.status()[1].holder, "tester");
  EXPECT_EQ(peers.status()[2].holder, "usurper");
}

TEST_F(PartOfASession, H13_RobotByRobotUntilNoneIsLeft) {
  for (const char* robot : {"robot0", "robot1", "robot2"}) {
    peers.say(robot, takeover(robot));
  }
  const auto& inbox = peers.inboxes["p"];
  ASSERT_EQ(inbox.size(), 3U);
  EXPECT_EQ(inbox[1].error().robot(), "robot1");
  EXPECT_EQ(inbox[2].displaced().by(), "usurper");
  peers.say("back", with_token(token));
  EXPECT_EQ(peers.told("back").refusal().error().code(), v1::Error::NO_SUCH_SESSION);
}

TEST(Takeover, H13_ARefusedOneDisplacesNoSession) {
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
  EXPECT_EQ(peers.status()[0].holder, "tester");
}

TEST(Takeover, L8_OfAConnectedSessionByItsToken) {
  for (const bool with_takeover : {false, true}) {
    const SmallRun small(2);
    Peers peers(small);
    const std::string token = peers.join("old", "*").session_token();
    peers.publish(1);
    peers.inboxes.clear();
    peers.say("new", with_token(token, with_takeover));
    EXPECT_TRUE(peers.told("old").has_displaced());
    ASSERT_EQ(peers.inboxes["new"].size(), 2U);
    EXPECT_EQ(peers.inboxes["new"][0].welcome().session_token(), token);
    EXPECT_EQ(peers.inboxes["new"][1].observation().tick(), 1U);
    peers.inboxes.clear();
    peers.say("old", Peers::command(1, {9}));
    EXPECT_EQ(peers.told("old").error().code(), v1::Error::OUT_OF_STATE);
    EXPECT_FALSE(peers.is_complete());
    peers.say("new", Peers::command(1));
    EXPECT_TRUE(peers.is_complete());
  }
}

TEST(Takeover, L8_TheOldConnectionNeedNotBeKnownToBeGone) {
  const SmallRun small(2);
  Peers peers(small);
  std::string token = peers.join("0", "*").session_token();
  peers.publish(1);
  for (int i = 1; i < 100; ++i) {
    const std::string peer = std::to_string(i);
    peers.unreachable.insert(std::to_string(i - 1));  // found out by the attempt to tell it
    peers.say(peer, with_token(token));
    ASSERT_EQ(peers.inboxes[peer].size(), 2U);
    EXPECT_EQ(peers.inboxes[peer][1].observation().tick(), 1U);
  }
  EXPECT_EQ(peers.barrier.sessions.size(), 1U);
  peers.say("99", Peers::command(1));
  EXPECT_TRUE(peers.is_complete());
}

TEST(Takeover, L8_ARefusedTokenDisplacesNoConnection) {
  const SmallRun small(2);
  Config config;
  config.deadlines = {{{}, true}};
  Peers peers(small, config);
  auto hello = wish("", v1::DeadlinePolicy::HOLD, 10);
  hello.mutable_hello()->set_session_token(peers.join("old", "*").session_token());
  peers.say("new", hello);
  EXPECT_EQ(peers.told("new").refusal().error().code(), v1::Error::FORBIDDEN);
  EXPECT_TRUE(peers.inboxes["old"].empty());
  peers.publish(1);
  EXPECT_TRUE(peers.told("old").has_observation());
}

TEST(Takeover, L10_ADisplacedTokenIsGoodForNothing) {
  const SmallRun small(2);
  Peers peers(small);
  const std::string token = peers.join("old", "*").session_token();
  peers.say("new", takeover("*"));
  peers.say("new", Peers::leave());
  peers.inboxes.clear();
  peers.say("old", with_token(token));
  EXPECT_EQ(peers.told("old").refusal().error().code(), v1::Error::NO_SUCH_SESSION);
}

TEST(Reset, L6_ASessionBeforeTick0GetsNoTickOfTheFormerWorld) {
  Pair pair({});
  reset(pair.peers.barrier, 7);
  pair.peers.say("r", takeover("robot0"));
  EXPECT_TRUE(pair.peers.told("r").has_welcome());  // and nothing else
  EXPECT_EQ(pair.peers.inboxes["p"].back().message_case(), v1::ServerMessage::kDisplaced);
  pair.peers.publish(0);
  EXPECT_EQ(pair.peers.told("r").observation().tick(), 0U);
  pair.peers.say("r", Peers::command(0, {1}));
  pair.peers.say("q", Peers::command(0));
  EXPECT_TRUE(pair.peers.is_complete());
}

TEST(Sessions, ThousandsComeAndGo) {
  const SmallRun small(3);
  Config config;
  config.max_sessions = 4;
  config.max_supervisors = config.max_observers = 0;
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
  EXPECT_LE(peers.barrier.sessions.size(), 3U);
  EXPECT_LE(peers.barrier.connections.size(), 8U);
}

}  // namespace
}  // namespace ziggurat::network
