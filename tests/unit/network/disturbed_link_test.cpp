// SPDX-License-Identifier: MIT
// Messages that are held back or lost on purpose, by a clock that only the test moves.

#include "network/disturbed_link.h"

#include <gtest/gtest.h>

#include "peers.h"

namespace ziggurat::network {
namespace {

using namespace std::chrono_literals;
using Case = v1::ServerMessage::MessageCase;
using scene::DeadlineAction;

constexpr Disturbance both_ways{5ms, {}, 0};

/// Two robots: robot0 of the controller "lua", robot1 of "external". Both have a deadline of 50 ms.
Config config_with(const Injection& lua, const Injection& external = {}) {
  Config config;
  config.injections = {lua, external};
  config.deadlines.resize(2);
  config.keeps_reactions = true;
  for (auto& each : config.deadlines) each.policy = {DeadlineAction::hold, 50, 0};
  return config;
}

std::vector<Case> kinds_told(Peers& peers, const std::string& peer) {
  std::vector<Case> kinds;
  for (const auto& message : std::exchange(peers.inboxes[peer], {})) {
    kinds.push_back(message.message_case());
  }
  return kinds;
}

TEST(Delays, CountOnTheWayThereAndOnTheWayBack) {
  const SmallRun small(2);
  Peers peers(small, config_with({both_ways, both_ways}));
  peers.join("a", "robot0");
  peers.join("b", "robot1");
  peers.publish(0);
  EXPECT_EQ(peers.told("b").observation().tick(), 0U);
  peers.say("b", Peers::command(0));
  EXPECT_TRUE(peers.inboxes["a"].empty());
  EXPECT_EQ(peers.next_event(), peers.now + 5ms);
  peers.pass(4ms);
  EXPECT_TRUE(peers.inboxes["a"].empty());
  peers.pass(1ms);
  EXPECT_TRUE(peers.told("a").has_observation());
  peers.say("a", Peers::command(0, {1.5}));
  EXPECT_FALSE(peers.is_complete());
  peers.pass(4ms);
  EXPECT_FALSE(peers.is_complete());
  EXPECT_EQ(peers.commands.joint_targets[0], 0);
  peers.pass(1ms);
  EXPECT_TRUE(peers.is_complete());
  EXPECT_EQ(peers.commands.joint_targets[0], 1.5);
  const auto& reactions = peers.barrier.reactions.all;
  ASSERT_EQ(reactions.size(), 2U);
  EXPECT_EQ(reactions[1].controller, 0U);
  EXPECT_NEAR(reactions[1].seconds, 10e-3, 1e-9);
  EXPECT_NEAR(reactions[0].seconds, 0, 1e-9);
}

TEST(Delays, NothingOvertakesAnObservation) {
  const SmallRun small(1);
  Peers peers(small, config_with({{80ms, {}, 0}, {}}));
  peers.join("a", "robot0");
  peers.publish(0);
  peers.say("a", Peers::heartbeat(7));
  peers.pass(50ms);  // the deadline: it counts from the moment at which the server sent
  EXPECT_TRUE(peers.is_complete());
  EXPECT_EQ(peers.barrier.deadlines.missed_ticks()[0], 1U);
  EXPECT_TRUE(peers.inboxes["a"].empty());
  peers.pass(30ms);
  EXPECT_EQ(kinds_told(peers, "a"),
            (std::vector{Case::kObservation, Case::kHeartbeat, Case::kError}));
  peers.say("a", Peers::command(0));  // late, and told so
  EXPECT_EQ(peers.told("a").error().code(), v1::Error::STALE_TICK);
}

TEST(Delays, NothingOvertakesACommand) {
  const SmallRun small(1);
  Peers peers(small, config_with({{}, both_ways}));
  peers.join("a", "robot0");
  peers.publish(0);
  peers.told("a");
  peers.say("a", Peers::command(0));
  peers.say("a", Peers::leave({}, v1::Leave::FAILED));
  EXPECT_FALSE(peers.is_complete());
  peers.pass(5ms);
  EXPECT_TRUE(peers.is_complete());
  EXPECT_EQ(peers.barrier.reactions.all.size(), 1U);
  EXPECT_EQ(peers.take_report().failures.size(), 1U);
}

TEST(Losses, CountAsMissesOfTheDisturbedSessionOnly) {
  const SmallRun small(2);
  Peers peers(small, config_with({{}, {{}, {}, 1}}));
  peers.join("a", "robot0");
  peers.join("b", "robot1");
  for (std::uint64_t tick = 0; tick < 20; ++tick) {
    peers.publish(tick);
    peers.say("a", Peers::command(tick, {1.0}));
    peers.say("b", Peers::command(tick, {2.0}));
    EXPECT_FALSE(peers.is_complete());
    peers.pass(50ms);
    EXPECT_TRUE(peers.is_complete());
  }
  EXPECT_EQ(peers.barrier.deadlines.missed_ticks(), (std::vector<std::uint64_t>{20, 0}));
  EXPECT_EQ(peers.link->lost_messages()[0].commands, 20U);
  EXPECT_EQ(peers.link->lost_messages()[0].observations, 0U);
  EXPECT_EQ(peers.link->lost_messages()[1].commands, 0U);
  EXPECT_EQ(peers.commands.joint_targets, (std::vector<double>{0, 2}));
}

/// The ticks that "a" misses when a third of what it is told is lost.
std::vector<std::uint64_t> ticks_missed(const std::string& other_first) {
  const SmallRun small(2);
  Peers peers(small, config_with({{{}, {}, 1.0 / 3}, {}}));
  peers.join(other_first == "b" ? "b" : "a", other_first == "b" ? "robot1" : "robot0");
  peers.join(other_first == "b" ? "a" : "b", other_first == "b" ? "robot0" : "robot1");
  std::vector<std::uint64_t> missed;
  for (std::uint64_t tick = 0; tick < 60; ++tick) {
    peers.publish(tick);
    const bool is_there = peers.told("a").has_observation();
    if (other_first == "b") peers.say("b", Peers::command(tick));
    if (is_there) peers.say("a", Peers::command(tick));
    if (other_first != "b") peers.say("b", Peers::command(tick));
    if (!is_there) missed.push_back(tick);
    EXPECT_EQ(peers.is_complete(), is_there);
    peers.pass(50ms);
    EXPECT_TRUE(peers.is_complete());
    peers.inboxes.clear();
  }
  EXPECT_EQ(peers.barrier.deadlines.missed_ticks()[0], missed.size());
  return missed;
}

TEST(Losses, AreTheSameAgainInAnyOrderOfArrival) {
  const auto missed = ticks_missed("a");
  EXPECT_GT(missed.size(), 8U);
  EXPECT_LT(missed.size(), 35U);
  EXPECT_EQ(ticks_missed("b"), missed);
}

TEST(Losses, DoNotAffectSessionsWithoutDeadline) {
  const SmallRun small(2);
  Config config = config_with({{{}, {}, 1}, {{}, {}, 1}});
  config.deadlines[1].policy = {};  // so that a session with both is waited for, too
  Peers peers(small, config);
  peers.join("a", "*");
  const auto notices = peers.link->take_notices();
  ASSERT_EQ(notices.size(), 1U);
  EXPECT_NE(notices[0].find("none of its messages is lost"), std::string::npos) << notices[0];
  peers.publish(0);
  EXPECT_TRUE(peers.told("a").has_observation());
  peers.say("a", Peers::command(0));
  EXPECT_TRUE(peers.is_complete());
}

TEST(Delays, OfASessionWithSeveralControllersAreTheLongest) {
  const SmallRun small(2);
  Peers peers(small, config_with({{5ms, {}, 0}, {}}, {{9ms, {}, 0}, {}}));
  peers.join("a", "*");
  peers.publish(0);
  peers.pass(8ms);
  EXPECT_TRUE(peers.inboxes["a"].empty());
  peers.pass(1ms);
  EXPECT_TRUE(peers.told("a").has_observation());
}

TEST(Delays, EndWithTheRun) {
  const SmallRun small(1);
  Peers peers(small, config_with({{1s, {}, 0}, {1s, {}, 0}}));
  peers.join("a", "robot0");
  peers.publish(0);
  finish(peers.barrier, {wire::EndReason::finished, {}, 0});
  EXPECT_EQ(kinds_told(peers, "a"), (std::vector{Case::kObservation, Case::kEnd}));
  peers.say("a", Peers::leave());
  EXPECT_EQ(peers.barrier.sessions.size(), 0U);
}

TEST(Delays, EndWithTheSession) {
  const SmallRun small(1);
  Peers peers(small, config_with({{}, both_ways}));
  peers.join("a", "robot0");
  peers.publish(0);
  peers.say("a", Peers::command(0, {1.0}));
  peers.unreachable.insert("a");
  peers.say("b", Peers::hello("robot0"));  // takes it, as "a" is not there any more
  EXPECT_TRUE(peers.is_gathered());
  peers.pass(5ms);
  EXPECT_FALSE(peers.is_complete());
  EXPECT_EQ(peers.commands.joint_targets[0], 0);
}

TEST(Delays, HoldNoMoreThanTwoOfTheLargestMessages) {
  const SmallRun small(1);
  Config config = config_with({{}, {5s, {}, 0}});
  auto command = Peers::command(0);
  command.mutable_command()->add_log()->set_text(std::string(1000, 'x'));
  config.max_message_bytes = command.SerializeAsString().size() / 2 * 3 + 2;
  config.deadlines[0].policy = {DeadlineAction::hold, 9000, 0};
  Peers peers(small, config);
  peers.join("a", "robot0");
  peers.publish(0);
  peers.told("a");
  for (int i = 0; i < 3; ++i) peers.say("a", command);
  peers.pass(1ms);
  EXPECT_FALSE(peers.is_complete());
  peers.say("a", command);  // more than that: all of them arrive
  peers.pass(1ms);
  EXPECT_TRUE(peers.is_complete());
}

TEST(Delays, DoNotAffectOtherControllers) {
  const SmallRun small(2);
  Peers peers(small, config_with({}, {{1s, {}, 0}, {1s, {}, 0}}));
  peers.join("a", "robot0");
  peers.say("other", Peers::command(0));
  EXPECT_EQ(peers.told("other").error().code(), v1::Error::OUT_OF_STATE);
  peers.publish(0);
  EXPECT_TRUE(peers.told("a").has_observation());
  EXPECT_EQ(peers.link->next_event(), never);
}

/// So that the newest wins where a client does not read (W8), and it is not disconnected.
TEST(Delays, AnObservationIsSentAsOneNowOrLater) {
  for (const Injection& injection : {Injection{both_ways, {}}, Injection{{}, both_ways}}) {
    const SmallRun small(1);
    Peers peers(small, config_with(injection));
    peers.join("a", "robot0");
    peers.say("a", Peers::heartbeat(1));
    peers.publish(0);
    peers.pass(5ms);
    EXPECT_EQ(peers.observations_sent, 1);
  }
}

TEST(Delays, AConnectionThatBreaksMeanwhileIsFoundOut) {
  const SmallRun small(1);
  Peers peers(small, config_with({both_ways, {}}));
  peers.join("a", "robot0");
  peers.publish(0);
  peers.unreachable.insert("a");
  peers.pass(5ms);
  peers.probe();
  EXPECT_FALSE(peers.is_gathered());
}

TEST(Delays, ALinkForgetsSessionsThatAreOver) {
  const SmallRun small(1);
  Peers peers(small, config_with({{}, both_ways}));
  peers.join("a", "robot0");
  peers.publish(0);
  peers.say("a", Peers::command(0));
  peers.say("a", Peers::leave());
  peers.pass(5ms);
  EXPECT_EQ(peers.link->next_event(), never);
  peers.inboxes.clear();
  peers.say("a", Peers::hello("robot0"));
  EXPECT_EQ(peers.told("a").refusal().error().code(), v1::Error::NOT_YOURS);
}

}  // namespace
}  // namespace ziggurat::network
