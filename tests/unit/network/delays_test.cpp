// Messages that are held back or lost on purpose, by a clock that only the test moves.

#include "network/delays.h"

#include <gtest/gtest.h>

#include <cmath>

#include "peers.h"

namespace ziggurat::network {
namespace {

using namespace std::chrono_literals;
using Case = v1::ServerMessage::MessageCase;
using scene::DeadlineAction;

constexpr Disturbance both_ways{5ms, {}, 0};

// --- fates --------------------------------------------------------------------------------------

TEST(Fate, DependsOnNothingButItsName) {
  const Disturbance disturbance{5ms, 2ms, 0.5};
  const auto draw = [&](std::uint64_t seed, const char* path, Direction direction,
                        std::uint64_t tick) {
    return draw_fate(disturbance, seed, path, direction, tick).delay;
  };
  const auto one = draw(1, "drive/r0", Direction::commands, 7);
  EXPECT_EQ(draw(1, "drive/r0", Direction::commands, 7), one);
  EXPECT_NE(draw(2, "drive/r0", Direction::commands, 7), one);
  EXPECT_NE(draw(1, "drive/r1", Direction::commands, 7), one);
  EXPECT_NE(draw(1, "drive/r0", Direction::observations, 7), one);
  EXPECT_NE(draw(1, "drive/r0", Direction::commands, 8), one);
}

TEST(Fate, DelaysAreUniformAndLossesAsManyAsSaid) {
  const Disturbance disturbance{5ms, 2ms, 0.25};
  constexpr int draws = 20'000;
  double sum = 0, squares = 0;
  int lost = 0;
  for (std::uint64_t tick = 0; tick < draws; ++tick) {
    const Fate fate = draw_fate(disturbance, 3, "drive/r0", Direction::commands, tick);
    ASSERT_GE(fate.delay, 3ms);
    ASSERT_LE(fate.delay, 7ms);
    const double off = (static_cast<double>(fate.delay.count()) - 5e6) / 2e6;
    sum += off;
    squares += off * off;
    lost += fate.is_lost ? 1 : 0;
    // Delays change no losses.
    ASSERT_EQ(draw_fate({{}, {}, 0.25}, 3, "drive/r0", Direction::commands, tick).is_lost,
              fate.is_lost);
  }
  // Four standard deviations of what a uniform number in [-1, 1] and a coin give.
  EXPECT_NEAR(sum / draws, 0, 4 * std::sqrt(1.0 / 3 / draws));
  EXPECT_NEAR(squares / draws, 1.0 / 3, 4 * std::sqrt(4.0 / 45 / draws));
  EXPECT_NEAR(lost, draws * 0.25, 4 * std::sqrt(draws * 0.25 * 0.75));
}

TEST(Fate, AllOrNothing) {
  for (std::uint64_t tick = 0; tick < 100; ++tick) {
    EXPECT_TRUE(draw_fate({{}, {}, 1}, 1, "", Direction::commands, tick).is_lost);
    EXPECT_FALSE(draw_fate({5ms, {}, 0}, 1, "", Direction::commands, tick).is_lost);
    EXPECT_EQ(draw_fate({5ms, {}, 0}, 1, "", Direction::commands, tick).delay, 5ms);
  }
}

TEST(DelayLine, NobodyOvertakes) {
  DelayLine<int> line;
  const DelayLine<int>::Time now;
  line.push(now + 9ms, 1);
  line.push(now + 2ms, 2);
  EXPECT_EQ(line.due(), now + 9ms);
  EXPECT_FALSE(line.pop(now + 8ms));
  EXPECT_EQ(line.pop(now + 9ms), 1);
  EXPECT_EQ(line.pop(now + 9ms), 2);
  EXPECT_EQ(line.due(), DelayLine<int>::Time::max());
}

// --- sessions -----------------------------------------------------------------------------------

/// Two robots: robot0 of the controller "lua", robot1 of "external". Both are held after 50 ms.
Config config_with(const Injection& lua, const Injection& external = {}) {
  Config config;
  config.injections = {lua, external};
  config.deadlines.resize(2);
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
  EXPECT_EQ(peers.barrier.due(), peers.now + 5ms);
  peers.pass(4ms);
  EXPECT_TRUE(peers.inboxes["a"].empty());
  peers.pass(1ms);
  EXPECT_TRUE(peers.told("a").has_observation());
  peers.say("a", Peers::command(0, {1.5}));
  EXPECT_FALSE(peers.barrier.complete());
  peers.pass(4ms);
  EXPECT_FALSE(peers.barrier.complete());
  EXPECT_EQ(peers.commands.joint_targets[0], 0);
  peers.pass(1ms);
  EXPECT_TRUE(peers.barrier.complete());
  EXPECT_EQ(peers.commands.joint_targets[0], 1.5);
  EXPECT_NEAR(peers.barrier.latencies()[0].max(), 10e-3, 1e-9);
  EXPECT_NEAR(peers.barrier.latencies()[1].max(), 0, 1e-9);
}

TEST(Delays, NothingOvertakesAnObservation) {
  const SmallRun small(1);
  Peers peers(small, config_with({{80ms, {}, 0}, {}}));
  peers.join("a", "robot0");
  peers.publish(0);
  peers.say("a", Peers::heartbeat(7));
  peers.pass(50ms);  // the deadline: it counts from the moment at which the server sent
  EXPECT_TRUE(peers.barrier.complete());
  EXPECT_EQ(peers.barrier.missed_ticks()[0], 1U);
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
  EXPECT_FALSE(peers.barrier.complete());
  peers.pass(5ms);
  EXPECT_TRUE(peers.barrier.complete());
  EXPECT_EQ(peers.barrier.latencies()[0].count(), 1U);
  EXPECT_EQ(peers.barrier.take_report().failures.size(), 1U);
}

TEST(Losses, AreMissesOfTheOneAndNotOfTheOther) {
  const SmallRun small(2);
  Peers peers(small, config_with({{}, {{}, {}, 1}}));
  peers.join("a", "robot0");
  peers.join("b", "robot1");
  for (std::uint64_t tick = 0; tick < 20; ++tick) {
    peers.publish(tick);
    peers.say("a", Peers::command(tick, {1.0}));
    peers.say("b", Peers::command(tick, {2.0}));
    EXPECT_FALSE(peers.barrier.complete());
    peers.pass(50ms);
    EXPECT_TRUE(peers.barrier.complete());
  }
  EXPECT_EQ(peers.barrier.missed_ticks(), (std::vector<std::uint64_t>{20, 0}));
  EXPECT_EQ(peers.barrier.lost_messages()[0].commands, 20U);
  EXPECT_EQ(peers.barrier.lost_messages()[0].observations, 0U);
  EXPECT_EQ(peers.barrier.lost_messages()[1].commands, 0U);
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
    EXPECT_EQ(peers.barrier.complete(), is_there);
    peers.pass(50ms);
    EXPECT_TRUE(peers.barrier.complete());
    peers.inboxes.clear();
  }
  EXPECT_EQ(peers.barrier.missed_ticks()[0], missed.size());
  return missed;
}

TEST(Losses, AreTheSameAgainWhoeverComesFirst) {
  const auto missed = ticks_missed("a");
  EXPECT_GT(missed.size(), 8U);
  EXPECT_LT(missed.size(), 35U);
  EXPECT_EQ(ticks_missed("b"), missed);
}

TEST(Losses, DoNotMeetWhoIsWaitedFor) {
  const SmallRun small(2);
  Config config = config_with({{{}, {}, 1}, {{}, {}, 1}});
  config.deadlines[1].policy = {};  // so that a session with both is waited for, too
  Peers peers(small, config);
  peers.join("a", "*");
  const auto notices = peers.barrier.take_report().notices;
  ASSERT_EQ(notices.size(), 1U);
  EXPECT_NE(notices[0].find("none of its messages is lost"), std::string::npos) << notices[0];
  peers.publish(0);
  EXPECT_TRUE(peers.told("a").has_observation());
  peers.say("a", Peers::command(0));
  EXPECT_TRUE(peers.barrier.complete());
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
  peers.barrier.finish({wire::EndReason::finished, {}, 0});
  EXPECT_EQ(kinds_told(peers, "a"), (std::vector{Case::kObservation, Case::kEnd}));
  peers.say("a", Peers::leave());
  EXPECT_TRUE(peers.barrier.drained());
}

TEST(Delays, EndWithTheSession) {
  const SmallRun small(1);
  Peers peers(small, config_with({{}, both_ways}));
  peers.join("a", "robot0");
  peers.publish(0);
  peers.say("a", Peers::command(0, {1.0}));
  peers.unreachable.insert("a");
  peers.say("b", Peers::hello("robot0"));  // takes it, as nobody is there any more
  EXPECT_TRUE(peers.barrier.gathered());
  peers.pass(5ms);
  EXPECT_FALSE(peers.barrier.complete());
  EXPECT_EQ(peers.commands.joint_targets[0], 0);
}

TEST(Delays, KeepNoMoreThanTwoOfTheLargestMessages) {
  const SmallRun small(1);
  Config config = config_with({{}, {5s, {}, 0}});
  auto command = Peers::command(0);
  command.mutable_command()->add_log()->set_text(std::string(1000, 'x'));
  config.max_message_bytes = bytes_of(command, talks_json()).size() / 2 * 3 + 2;
  config.deadlines[0].policy = {DeadlineAction::hold, 9000, 0};
  Peers peers(small, config);
  peers.join("a", "robot0");
  peers.publish(0);
  peers.told("a");
  for (int i = 0; i < 3; ++i) peers.say("a", command);
  EXPECT_TRUE(peers.inboxes["a"].empty());
  peers.say("a", command);
  EXPECT_EQ(peers.told("a").error().code(), v1::Error::TOO_MANY);
  EXPECT_FALSE(peers.barrier.gathered());
}

}  // namespace
}  // namespace ziggurat::network
