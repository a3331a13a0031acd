// SPDX-License-Identifier: MIT
// Response times kept for a report card, by a clock that only the test moves.

#include "network/barrier/answer_timing.h"

#include <gtest/gtest.h>

#include "network/peers.h"

namespace ziggurat::network {
namespace {

using scene::DeadlineAction;
using std::chrono::milliseconds;

Config keeping(DeadlineAction action, std::uint32_t budget = 0) {
  Config config;
  config.deadlines.assign(2, {{action, 50, budget}, true});
  config.heartbeat = milliseconds{100'000};  // out of the way
  config.keeps_reactions = true;
  return config;
}

/// "p" has the two robots, one of each controller, and a deadline of 50 ms.
struct AnswerTiming : ::testing::Test {
  explicit AnswerTiming(const Config& config = keeping(DeadlineAction::hold))
      : small(2), peers(small, config) {
    peers.join("p", "*");
  }
  /// Reactions of the first controller's robots, in the order in which they were known.
  std::vector<Reaction> kept() const {
    std::vector<Reaction> result;
    for (const Reaction& one : peers.barrier.reactions.all) {
      if (one.controller == 0) result.push_back(one);
    }
    EXPECT_EQ(peers.barrier.reactions.all.size(), 2 * result.size())
        << "each controller has its own";
    return result;
  }
  static void expect(const Reaction& one, std::uint64_t tick, Reaction::Kind kind, double seconds) {
    EXPECT_EQ(one.tick, tick);
    EXPECT_EQ(one.kind, kind) << tick;
    EXPECT_NEAR(one.seconds, seconds, 1e-9) << tick;
  }
  SmallRun small;
  Peers peers;
};

TEST_F(AnswerTiming, AnAnswerInTime) {
  peers.publish(0);
  peers.pass(milliseconds{7});
  peers.say("p", Peers::command(0));
  ASSERT_EQ(kept().size(), 1U);
  expect(kept()[0], 0, Reaction::Kind::in_time, 7e-3);
}

TEST_F(AnswerTiming, DeadlinesBeginWhenTheObservationsAreSent) {
  peers.publish(0);
  peers.now += milliseconds{60};  // the server was stopped
  await_from(peers.barrier, peers.now);
  peers.pass(milliseconds{49});
  EXPECT_FALSE(peers.is_complete()) << "it is not missed yet";
  peers.say("p", Peers::command(0));
  ASSERT_EQ(kept().size(), 1U);
  expect(kept()[0], 0, Reaction::Kind::in_time, 49e-3);
  peers.publish(1);
  peers.now += milliseconds{60};
  await_from(peers.barrier, peers.now);
  peers.pass(milliseconds{50});
  EXPECT_TRUE(peers.is_complete());
}

TEST_F(AnswerTiming, ALateAnswerCountsWithItsWholeTime) {
  peers.publish(0);
  peers.pass(milliseconds{50});
  peers.publish(1);
  peers.pass(milliseconds{30});
  EXPECT_TRUE(kept().empty()) << "it may still come";
  peers.say("p", Peers::command(0));
  peers.say("p", Peers::command(1));
  ASSERT_EQ(kept().size(), 2U);
  expect(kept()[0], 0, Reaction::Kind::late, 80e-3);
  expect(kept()[1], 1, Reaction::Kind::in_time, 30e-3);
}

TEST_F(AnswerTiming, AnObservationThatIsNeverAnsweredCountsUntilALaterAnswer) {
  peers.publish(0);
  peers.pass(milliseconds{50});
  peers.publish(1);
  peers.pass(milliseconds{50});
  peers.publish(2);
  peers.pass(milliseconds{10});
  peers.say("p", Peers::command(1));
  peers.say("p", Peers::command(2));
  ASSERT_EQ(kept().size(), 3U);
  expect(kept()[0], 0, Reaction::Kind::unanswered, 110e-3);
  expect(kept()[1], 1, Reaction::Kind::late, 60e-3);
  expect(kept()[2], 2, Reaction::Kind::in_time, 10e-3);
}

TEST_F(AnswerTiming, OrUntilTheEndOfTheRun) {
  peers.publish(0);
  peers.pass(milliseconds{50});
  peers.publish(1);
  peers.pass(milliseconds{20});
  finish(peers.barrier, {});
  ASSERT_EQ(kept().size(), 1U) << "it did not miss tick 1";
  expect(kept()[0], 0, Reaction::Kind::unanswered, 70e-3);
  peers.say("p", Peers::leave());
  EXPECT_EQ(kept().size(), 1U) << "once";
}

TEST_F(AnswerTiming, OrUntilTheConnectionIsGone) {
  peers.publish(0);
  peers.pass(milliseconds{50});
  peers.publish(1);
  disconnect(peers.barrier, "p");
  ASSERT_EQ(kept().size(), 1U);
  expect(kept()[0], 0, Reaction::Kind::unanswered, 50e-3);
  peers.pass(milliseconds{50});
  ASSERT_EQ(kept().size(), 2U) << "free robots miss ticks, too";
  expect(kept()[1], 1, Reaction::Kind::unanswered, 50e-3);
}

TEST_F(AnswerTiming, AResetBeginsAnotherWorld) {
  peers.publish(0);
  peers.pass(milliseconds{50});
  network::restart(peers.barrier, {42});
  peers.publish(0);
  peers.say("p", Peers::command(0));
  ASSERT_EQ(kept().size(), 2U);
  expect(kept()[0], 0, Reaction::Kind::unanswered, 50e-3);
  EXPECT_EQ(kept()[0].world, 0U);
  expect(kept()[1], 0, Reaction::Kind::in_time, 0);
  EXPECT_EQ(kept()[1].world, 1U);
}

struct Dropping : AnswerTiming {
  Dropping() : AnswerTiming(keeping(DeadlineAction::drop, 1)) {}
};

TEST_F(Dropping, DroppedRobotsHaveTheirLastMissAndNoMore) {
  peers.publish(0);
  peers.pass(milliseconds{50});
  peers.publish(1);
  peers.pass(milliseconds{50});
  peers.publish(2);
  peers.pass(milliseconds{50});
  ASSERT_EQ(kept().size(), 2U);
  expect(kept()[0], 0, Reaction::Kind::unanswered, 100e-3);
  expect(kept()[1], 1, Reaction::Kind::unanswered, 50e-3);
}

TEST(NotMeasuring, NothingIsKeptUnlessItIsWanted) {
  const SmallRun small(2);
  Config config = keeping(DeadlineAction::hold);
  config.keeps_reactions = false;
  Peers peers(small, config);
  peers.join("p", "*");
  for (std::uint64_t tick = 0; tick < 5; ++tick) {
    peers.publish(tick);
    if (tick % 2 == 0) peers.pass(milliseconds{50});
    peers.say("p", Peers::command(tick));
  }
  EXPECT_TRUE(peers.barrier.reactions.all.empty());
}

TEST(MissNotices, AreSummarised) {
  const SmallRun small(1);
  Peers peers(small, keeping(DeadlineAction::hold));
  peers.join("p", "*");
  std::vector<std::string> notices;
  for (std::uint64_t tick = 0; tick < 400; ++tick) {  // 20 s
    peers.publish(tick);
    if (tick % 2 == 1) peers.say("p", Peers::command(tick));
    peers.pass(milliseconds{50});
    for (auto& notice : peers.take_report().notices) notices.push_back(notice);
  }
  ASSERT_EQ(notices.size(), 2U);
  EXPECT_NE(notices[0].find("missed its deadline of 50 ms at tick 0"), std::string::npos);
  EXPECT_NE(notices[1].find("missed its deadline of 50 ms at 100 of the ticks 2 to 200"),
            std::string::npos)
      << notices[1];
}

}  // namespace
}  // namespace ziggurat::network
