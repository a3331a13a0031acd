// The numbered rules of docs/protocol.md. A test is named after the rule it holds.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "network/peers.h"

namespace ziggurat::network {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

v1::Error refused(Peers& peers, const v1::ClientMessage& hello) {
  peers.say("p", hello);
  const v1::ServerMessage told = peers.told("p");
  EXPECT_TRUE(told.has_refusal()) << told.ShortDebugString();
  EXPECT_EQ(told.refusal().error().severity(), v1::Error::FATAL);
  EXPECT_FALSE(told.refusal().error().message().empty());
  return told.refusal().error();
}

v1::Error faulted(Peers& peers, const v1::ClientMessage& message) {
  const auto commands = peers.commands.joint_targets;
  peers.say("p", message);
  const v1::ServerMessage told = peers.told("p");
  EXPECT_TRUE(told.has_error()) << told.ShortDebugString();
  EXPECT_EQ(told.error().severity(), v1::Error::DISCARD);
  EXPECT_FALSE(told.error().message().empty());
  EXPECT_EQ(peers.commands.joint_targets, commands) << "a discarded message had effect";
  EXPECT_TRUE(peers.take_report().log.empty());
  return told.error();
}

/// Four robots; "p" holds robot0, robot1 and robot3 and owes tick 5, "q" holds robot2 and has
/// answered.
struct Stepping : ::testing::Test {
  Stepping() : small(4), peers(small) {
    auto hello = Peers::hello("robot[013]");
    peers.say("p", hello);
    peers.join("q", "robot2");
    peers.publish(5);
    peers.say("q", Peers::command(5));
    peers.inboxes.clear();
  }
  SmallRun small;
  Peers peers;
};

// ---- transport ----------------------------------------------------------------------------------

TEST(Transport, T2_GarbageIsMalformedAndDisturbsNoSession) {
  const SmallRun small(1);
  Peers peers(small);
  peers.join("p", "*");
  peers.publish(0);
  peers.inboxes.clear();
  for (const std::string& bytes : {std::string("hello"), std::string(1000, '\xff'), std::string(),
                                   std::string("\x12\x7f", 2), std::string("\x12\xff\xff", 3)}) {
    peers.send_bytes("unknown", bytes);
    const auto error = peers.told("unknown").error();
    EXPECT_EQ(error.code(), v1::Error::MALFORMED);
    EXPECT_EQ(error.severity(), v1::Error::FATAL);
  }
  EXPECT_TRUE(peers.told("p").message_case() == v1::ServerMessage::MESSAGE_NOT_SET);
  peers.say("p", Peers::command(0));
  EXPECT_TRUE(peers.is_complete());
}

TEST(Transport, T4_TooLarge) {
  const SmallRun small(1);
  Config config;
  config.max_message_bytes = 1000;
  Peers peers(small, config);
  EXPECT_EQ(peers.join("p", "*").max_message_bytes(), 1000U);
  peers.publish(0);
  peers.inboxes.clear();
  auto command = Peers::command(0);
  command.mutable_command()->add_log()->set_text(std::string(1000, 'x'));
  EXPECT_EQ(faulted(peers, command).code(), v1::Error::TOO_LARGE);
}

TEST(Transport, T5_UnknownFieldsAreIgnored) {
  if (talks_json()) GTEST_SKIP() << "json_test.cpp has the twin";
  const SmallRun small(1);
  Peers peers(small);
  peers.join("p", "*");
  peers.publish(0);
  // Field 15 of Command, which this version does not have, inside ClientMessage.command.
  peers.send_bytes("p", std::string("\x12\x02\x78\x01", 4));
  EXPECT_TRUE(peers.is_complete());
}

// ---- beginning ----------------------------------------------------------------------------------

TEST(Hello, H2_AnotherMajorVersionIsRefusedWithBoth) {
  const SmallRun small(1);
  Peers peers(small);
  auto hello = Peers::hello("*");
  hello.mutable_hello()->mutable_version()->set_major(2);
  peers.say("p", hello);
  const auto refusal = peers.told("p").refusal();
  EXPECT_EQ(refusal.error().code(), v1::Error::VERSION_MISMATCH);
  EXPECT_EQ(refusal.server_version().major(), 1U);
  EXPECT_EQ(refusal.client_version().major(), 2U);
  EXPECT_NE(refusal.error().message().find("2.0"), std::string::npos);
}

TEST(Hello, H2_TheLowerMinorVersionCounts) {
  const SmallRun small(1);
  Peers peers(small);
  auto hello = Peers::hello("*");
  hello.mutable_hello()->mutable_version()->set_minor(7);
  peers.say("p", hello);
  EXPECT_EQ(peers.told("p").welcome().version().minor(), 0U);
}

TEST(Hello, H3_Roles) {
  const SmallRun small(1);
  Peers peers(small);
  auto hello = Peers::hello("*");
  hello.mutable_hello()->set_role(v1::ROLE_SUPERVISOR);
  EXPECT_EQ(refused(peers, hello).code(), v1::Error::BAD_VALUE) << "it asks for robots";
  hello.mutable_hello()->set_role(v1::ROLE_UNSPECIFIED);
  EXPECT_EQ(refused(peers, hello).code(), v1::Error::BAD_VALUE);
  hello.mutable_hello()->set_role(static_cast<v1::Role>(-7));
  EXPECT_EQ(refused(peers, hello).code(), v1::Error::BAD_VALUE);
}

TEST(Hello, H4_CriteriaAreJoinedByAnd) {
  const SmallRun small(6);  // even ones are driven by scripts
  Peers peers(small);
  auto hello = Peers::hello("robot[0-3]");
  hello.mutable_hello()->set_lua_only(true);
  peers.say("r", hello);
  const auto welcome = peers.told("r").welcome();
  ASSERT_EQ(welcome.robots_size(), 2);
  EXPECT_EQ(welcome.robots(0).id(), "robot0");
  EXPECT_EQ(welcome.robots(1).id(), "robot2");
  hello = Peers::hello("*");
  hello.mutable_hello()->clear_robots();
  EXPECT_EQ(refused(peers, hello).code(), v1::Error::BAD_VALUE);
  hello.mutable_hello()->set_controller("external");
  peers.say("q", hello);
  EXPECT_EQ(peers.told("q").welcome().robots_size(), 3);
  EXPECT_FALSE(peers.is_gathered());
  peers.join("s", "robot4");
  EXPECT_TRUE(peers.is_gathered());
}

TEST(Hello, H4_AllOrNothing) {
  const SmallRun small(3);
  Peers peers(small);
  peers.join("q", "robot1");
  EXPECT_EQ(refused(peers, Peers::hello("*")).code(), v1::Error::ROBOT_TAKEN);
  EXPECT_EQ(peers.status()[0].membership, RobotStatus::Membership::free);
}

TEST(Hello, H5_UnknownNames) {
  const SmallRun small(1);
  Peers peers(small);
  EXPECT_EQ(refused(peers, Peers::hello("robot7")).code(), v1::Error::UNKNOWN_ROBOT);
  EXPECT_EQ(refused(peers, Peers::hello("x*")).code(), v1::Error::UNKNOWN_ROBOT);
  auto hello = Peers::hello("*");
  hello.mutable_hello()->set_controller("nobody");
  EXPECT_EQ(refused(peers, hello).code(), v1::Error::UNKNOWN_CONTROLLER);
}

TEST(Hello, H6_TheHolderIsNamedAndNotDisturbed) {
  const SmallRun small(1);
  Peers peers(small);
  peers.join("q", "*");
  peers.say("p", Peers::hello("robot0"));
  const auto refusal = peers.told("p").refusal();
  EXPECT_EQ(refusal.error().code(), v1::Error::ROBOT_TAKEN);
  EXPECT_EQ(refusal.error().robot(), "robot0");
  EXPECT_TRUE(refusal.error().retryable());
  EXPECT_EQ(refusal.holder(), "tester");
  EXPECT_EQ(peers.status()[0].holder, "tester");
}

TEST(Hello, H7_RobotsThatLeftStayGone) {
  const SmallRun small(2);
  Peers peers(small);
  peers.join("q", "robot0");
  peers.say("q", Peers::leave());
  EXPECT_EQ(refused(peers, Peers::hello("robot0")).code(), v1::Error::NOT_YOURS);
  EXPECT_EQ(peers.join("p", "*").robots_size(), 1);
}

TEST(Hello, H9_WelcomeDescribesRunAndRobots) {
  const SmallRun small(2);
  Peers peers(small);
  const auto welcome = peers.join("p", "*");
  EXPECT_EQ(welcome.tick_ns(), 100'000'000U);
  EXPECT_EQ(welcome.ticks_per_second(), 10U);
  EXPECT_EQ(welcome.seed(), 42U);
  EXPECT_EQ(welcome.scene_hash(), "0123456789abcdef");
  EXPECT_EQ(welcome.mode(), v1::MODE_LOCK_STEP);
  ASSERT_EQ(welcome.robots_size(), 2);
  const auto& robot = welcome.robots(0);
  EXPECT_EQ(robot.controller(), "lua");
  EXPECT_EQ(robot.script(), "/scenes/drive.lua");
  ASSERT_EQ(robot.params_size(), 2);
  EXPECT_EQ(robot.params(0).name(), "speed");
  EXPECT_EQ(robot.params(0).value(), "0");
  ASSERT_EQ(robot.joint_sensors_size(), 1);
  EXPECT_EQ(robot.joint_sensors(0).mode(), v1::JointDescription::POSITION);
  ASSERT_EQ(robot.joint_actuators_size(), 1);
  EXPECT_EQ(robot.joint_actuators(0).mode(), v1::JointDescription::VELOCITY);
  EXPECT_EQ(robot.joint_actuators(0).max_impulse(), 0.005);
  EXPECT_EQ(welcome.robots(1).script(), "");
}

TEST(Hello, H11_ALateSessionGetsTheTickThatTheOthersAreAt) {
  const SmallRun small(2);
  Peers peers(small);
  peers.join("q", "*");
  peers.publish(8);
  peers.unreachable.insert("q");
  peers.probe();
  peers.say("p", Peers::hello("robot1"));
  ASSERT_EQ(peers.inboxes["p"].size(), 2U);
  EXPECT_EQ(peers.inboxes["p"][1].observation().tick(), 8U);
  EXPECT_EQ(peers.inboxes["p"][1].observation().joint_readings(0), 801);
}

TEST(Hello, TooManySessions) {
  const SmallRun small(2);
  Config config;
  config.max_sessions = 1;
  Peers peers(small, config);
  peers.join("q", "robot0");
  const auto error = refused(peers, Peers::hello("robot1"));
  EXPECT_EQ(error.code(), v1::Error::TOO_MANY);
  EXPECT_TRUE(error.retryable());
}

TEST(Hello, TooManyPatterns) {
  const SmallRun small(1);
  Peers peers(small);
  auto hello = Peers::hello("*");
  for (int i = 0; i < 64; ++i) hello.mutable_hello()->add_robots("*a");
  EXPECT_EQ(refused(peers, hello).code(), v1::Error::TOO_MANY);
}

// ---- the tick -----------------------------------------------------------------------------------

TEST_F(Stepping, S2_ReadingsArePackedInWelcomesOrder) {
  peers.publish(6);
  const auto observation = peers.told("p").observation();
  EXPECT_EQ(observation.tick(), 6U);
  EXPECT_EQ(observation.time_ns(), 600'000'000);
  EXPECT_EQ(
      std::vector<double>(observation.joint_readings().begin(), observation.joint_readings().end()),
      (std::vector<double>{600, 601, 603}));
}

TEST_F(Stepping, S3_OnlyTheCommandReleasesTheTick) {
  EXPECT_FALSE(peers.is_complete());
  peers.say("p", Peers::heartbeat(1));
  EXPECT_FALSE(peers.is_complete());
  peers.say("p", Peers::leave({1}));
  EXPECT_FALSE(peers.is_complete());
  peers.say("p", Peers::command(5));
  EXPECT_TRUE(peers.is_complete());
}

TEST_F(Stepping, S5_TargetsStayUntilChanged) {
  peers.say("p", Peers::command(5, {1, 2, 4}));
  peers.publish(6);
  peers.say("p", Peers::command(6));
  EXPECT_EQ(peers.commands.joint_targets, (std::vector<double>{1, 2, 0, 4}));
}

TEST_F(Stepping, S6_SomeRobotsInAnyOrder) {
  auto command = Peers::command(5, {40, 10});
  command.mutable_command()->add_robots(2);
  command.mutable_command()->add_robots(0);
  peers.say("p", command);
  EXPECT_EQ(peers.commands.joint_targets, (std::vector<double>{10, 0, 0, 40}));
}

TEST_F(Stepping, S6_AnotherLengthIsABadValue) {
  for (const auto& targets : {std::vector<double>{1, 2}, std::vector<double>{1, 2, 3, 4}}) {
    const auto error = faulted(peers, Peers::command(5, targets));
    EXPECT_EQ(error.code(), v1::Error::BAD_VALUE);
    EXPECT_EQ(error.field(), "joint_targets");
    EXPECT_EQ(error.tick(), 5U);
  }
}

TEST_F(Stepping, S6_ValuesOfRobotsThatLeftAreIgnored) {
  peers.say("p", Peers::leave({1}));
  peers.say("p", Peers::command(5, {1, 2, 4}));
  EXPECT_EQ(peers.commands.joint_targets, (std::vector<double>{1, 0, 0, 4}));
}

TEST_F(Stepping, S7_Positions) {
  auto command = Peers::command(5);
  command.mutable_command()->add_robots(3);
  auto error = faulted(peers, command);
  EXPECT_EQ(error.code(), v1::Error::UNKNOWN_ROBOT);
  EXPECT_EQ(error.field(), "robots");
  command.mutable_command()->set_robots(0, 4'294'967'295U);
  EXPECT_EQ(faulted(peers, command).code(), v1::Error::UNKNOWN_ROBOT);
  command.mutable_command()->set_robots(0, 1);
  command.mutable_command()->add_robots(1);
  EXPECT_EQ(faulted(peers, command).code(), v1::Error::BAD_VALUE);
  peers.say("p", Peers::leave({1}));
  error = faulted(peers, command);
  EXPECT_EQ(error.code(), v1::Error::NOT_YOURS);
  EXPECT_EQ(error.robot(), "robot1");
}

TEST_F(Stepping, S8_NumbersAreFinite) {
  for (const double bad : {nan, infinity, -infinity}) {
    const auto error = faulted(peers, Peers::command(5, {1, 2, bad}));
    EXPECT_EQ(error.code(), v1::Error::BAD_VALUE);
    EXPECT_EQ(error.robot(), "robot3");
    EXPECT_NE(error.message().find("'hinge'"), std::string::npos);
  }
}

TEST_F(Stepping, S9_Ticks) {
  EXPECT_EQ(faulted(peers, Peers::command(4, {1, 2, 3})).code(), v1::Error::STALE_TICK);
  EXPECT_EQ(faulted(peers, Peers::command(6, {1, 2, 3})).code(), v1::Error::FUTURE_TICK);
  peers.say("p", Peers::command(5, {1, 2, 3}));
  EXPECT_EQ(faulted(peers, Peers::command(5, {7, 7, 7})).code(), v1::Error::DUPLICATE_TICK);
}

TEST_F(Stepping, S10_ABadCommandHasNoEffectAndARightOneMayFollow) {
  auto command = Peers::command(5, {1, 2, 3});
  auto& line = *command.mutable_command()->add_log();
  line.set_robot(3);  // the only fault, in the last field
  line.set_text("x");
  EXPECT_EQ(faulted(peers, command).code(), v1::Error::UNKNOWN_ROBOT);
  EXPECT_FALSE(peers.is_complete());
  line.set_robot(2);
  peers.say("p", command);
  EXPECT_TRUE(peers.is_complete());
  EXPECT_EQ(peers.commands.joint_targets, (std::vector<double>{1, 2, 0, 3}));
  const auto log = peers.take_report().log;
  ASSERT_EQ(log.size(), 1U);
  EXPECT_EQ(log[0].robot, 3U);
}

TEST_F(Stepping, S11_LinesComeInSceneOrder) {
  peers.say("p", Peers::command(5));
  peers.publish(6);
  const auto answer = [&](const std::string& peer, std::vector<std::uint32_t> robots) {
    auto command = Peers::command(6);
    int count = 0;
    for (const auto robot : robots) {
      auto& line = *command.mutable_command()->add_log();
      line.set_robot(robot);
      line.set_text(std::to_string(count++));
    }
    peers.say(peer, command);
  };
  answer("p", {2, 0, 2, 1});
  answer("q", {0});
  std::string text;
  for (const auto& line : peers.take_report().log) {
    text += std::to_string(line.robot) + ":" + line.text + " ";
  }
  EXPECT_EQ(text, "0:1 1:3 2:0 3:0 3:2 ");
}

// ---- who may say what ---------------------------------------------------------------------------

TEST_F(Stepping, M4_BadMessagesWithoutEndAreTheEnd) {
  for (int i = 0; i < 100; ++i) {
    peers.say("p", Peers::command(77));
    EXPECT_EQ(peers.told("p").error().severity(), v1::Error::DISCARD);
  }
  peers.say("p", Peers::command(77));
  const auto error = peers.told("p").error();
  EXPECT_EQ(error.code(), v1::Error::TOO_MANY);
  EXPECT_EQ(error.severity(), v1::Error::FATAL);
  EXPECT_EQ(peers.status()[0].membership, RobotStatus::Membership::free);
}

TEST_F(Stepping, M4_AGoodMessageStartsTheCountAnew) {
  for (int i = 0; i < 90; ++i) peers.say("p", Peers::command(77));
  peers.say("p", Peers::command(5));
  peers.publish(6);
  for (int i = 0; i < 90; ++i) peers.say("p", Peers::command(77));
  EXPECT_EQ(peers.status()[0].membership, RobotStatus::Membership::held);
}

TEST(PeersWithoutSession, LeaveNothingBehind) {
  const SmallRun small(1);
  Peers peers(small);
  for (int i = 0; i < 2'000; ++i) {
    const std::string peer = "unknown" + std::to_string(i);
    peers.send_bytes(peer, "garbage");
    peers.say(peer, Peers::hello("nobody"));
    peers.inboxes.clear();
  }
  EXPECT_EQ(peers.barrier.sessions.size(), 0U);  // not one session
  EXPECT_LE(peers.take_report().notices.size(), 100U);
}

TEST(PeersWithoutSession, TheirNamesStayOneShortLine) {
  const SmallRun small(1);
  Peers peers(small);
  auto hello = Peers::hello("nobody\n" + std::string(100'000, 'x'));
  hello.mutable_hello()->set_client_name("\x1b[31m\nevil" + std::string(100'000, 'y'));
  peers.say("p", hello);
  const auto notices = peers.take_report().notices;
  ASSERT_EQ(notices.size(), 1U);
  EXPECT_LT(notices[0].size(), 1001U);
  EXPECT_EQ(notices[0].find_first_of("\n\x1b"), std::string::npos);
}

// ---- leaving, losing, ending --------------------------------------------------------------------

TEST_F(Stepping, L1_CommandsOfRobotsThatLeftBecomeZero) {
  peers.say("p", Peers::command(5, {1, 2, 4}));
  peers.publish(6);
  peers.say("q", Peers::command(6, {3}));
  peers.say("p", Peers::leave({0, 2}));
  peers.say("p", Peers::command(6));
  zero_missing(peers.barrier, peers.commands);
  EXPECT_EQ(peers.commands.joint_targets, (std::vector<double>{0, 2, 3, 0}));
}

TEST_F(Stepping, L1_FailuresAreReportedOnce) {
  auto leave = Peers::leave({1}, v1::Leave::FAILED);
  leave.mutable_leave()->set_message("x.lua:3: oh");
  peers.say("p", leave);
  peers.say("p", leave);
  EXPECT_EQ(peers.told("p").error().code(), v1::Error::NOT_YOURS);
  const auto failures = peers.take_report().failures;
  ASSERT_EQ(failures.size(), 1U);
  EXPECT_EQ(failures[0].robot, 1U);
  EXPECT_EQ(failures[0].message, "x.lua:3: oh");
  EXPECT_EQ(failures[0].tick, 5U);
}

TEST_F(Stepping, L1_AReasonMustBeGiven) {
  auto leave = Peers::leave({1}, v1::Leave::REASON_UNSPECIFIED);
  EXPECT_EQ(faulted(peers, leave).code(), v1::Error::BAD_VALUE);
  EXPECT_EQ(peers.status()[1].membership, RobotStatus::Membership::held);
}

TEST_F(Stepping, L1_ABadPositionTakesNoRobotOut) {
  EXPECT_EQ(faulted(peers, Peers::leave({0, 1, 9})).code(), v1::Error::UNKNOWN_ROBOT);
  EXPECT_EQ(peers.status()[0].membership, RobotStatus::Membership::held);
}

TEST_F(Stepping, L2_AWholeSessionLeavesAndReleasesTheTick) {
  peers.say("p", Peers::leave({}, v1::Leave::FAILED));
  EXPECT_TRUE(peers.is_complete());
  EXPECT_EQ(peers.take_report().failures.size(), 3U);
  EXPECT_EQ(peers.status()[2].membership, RobotStatus::Membership::held);
}

TEST_F(Stepping, L3_ASessionWithoutRobotsIsToldTheEnd) {
  peers.say("p", Peers::leave({0, 1, 2}));
  EXPECT_FALSE(peers.is_complete());
  peers.say("p", Peers::command(5));
  EXPECT_TRUE(peers.is_complete());
  peers.inboxes.clear();
  peers.publish(6);
  EXPECT_TRUE(peers.inboxes["p"].empty());
  finish(peers.barrier, {wire::EndReason::failed, "all is lost", 6});
  const auto end = peers.told("p").end();
  EXPECT_EQ(end.reason(), v1::End::FAILED);
  EXPECT_EQ(end.message(), "all is lost");
  EXPECT_EQ(end.tick(), 6U);
}

TEST_F(Stepping, L4_ALostSessionResumesAtTheSameTick) {
  const SmallRun two(2);
  Peers fresh(two);
  const auto welcome = fresh.join("old", "*");
  fresh.publish(3);
  auto hello = Peers::hello("*");
  hello.mutable_hello()->set_session_token(welcome.session_token());
  fresh.inboxes.clear();
  fresh.unreachable.insert("old");
  fresh.say("new", hello);
  ASSERT_EQ(fresh.inboxes["new"].size(), 2U);
  EXPECT_EQ(fresh.inboxes["new"][0].welcome().session_token(), welcome.session_token());
  EXPECT_EQ(fresh.inboxes["new"][1].observation().tick(), 3U);
  EXPECT_FALSE(fresh.is_complete());
  fresh.say("new", Peers::command(3, {1, 2}));
  EXPECT_TRUE(fresh.is_complete());
  hello.mutable_hello()->set_session_token("guess");
  EXPECT_EQ(refused(fresh, hello).code(), v1::Error::NO_SUCH_SESSION);
}

TEST_F(Stepping, L4_TheBarrierWaitsForLostRobots) {
  peers.unreachable.insert("p");
  peers.publish(6);
  peers.say("q", Peers::command(6));
  EXPECT_FALSE(peers.is_complete());
  const std::vector<std::size_t> lost{0, 1, 3};
  remove_robots(peers.barrier, lost, {});
  EXPECT_TRUE(peers.is_complete());
  EXPECT_EQ(peers.take_report().notices.size(), 1U);
}

TEST_F(Stepping, L4_AHelloFindsADeadHolderOut) {
  peers.unreachable.insert("p");
  peers.say("new", Peers::hello("robot1"));
  EXPECT_TRUE(peers.inboxes["new"].front().has_welcome());
}

TEST_F(Stepping, L4_AnOldTokenIsWorthlessOnceOthersHaveTheRobots) {
  const SmallRun one(1);
  Peers fresh(one);
  const auto welcome = fresh.join("old", "*");
  fresh.unreachable.insert("old");
  fresh.join("new", "*");
  auto hello = Peers::hello("*");
  hello.mutable_hello()->set_session_token(welcome.session_token());
  fresh.inboxes.clear();
  EXPECT_EQ(refused(fresh, hello).code(), v1::Error::NO_SUCH_SESSION);
}

TEST_F(Stepping, L5_LastWordsComeWithTheLeave) {
  finish(peers.barrier, {});
  auto leave = Peers::leave();
  leave.mutable_leave()->add_log()->set_text("destroyed");
  peers.say("p", leave);
  ASSERT_EQ(peers.take_report().log.size(), 1U);
  EXPECT_NE(peers.barrier.sessions.size(), 0U);
  peers.say("q", Peers::leave());
  EXPECT_EQ(peers.barrier.sessions.size(), 0U);
}

TEST_F(Stepping, L5_NoSessionBeginsAfterTheEnd) {
  finish(peers.barrier, {});
  peers.say("late", Peers::hello("*"));
  EXPECT_EQ(peers.told("late").refusal().error().code(), v1::Error::OUT_OF_STATE);
}

}  // namespace
}  // namespace ziggurat::network
