// The rules of section 5 of docs/protocol.md: leaving, losing, ending. A test is named after its
// rule.

#include <gtest/gtest.h>

#include "rules.h"

namespace ziggurat::network {
namespace {

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

TEST_F(Stepping, L1_ABadPositionRemovesNoRobot) {
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
