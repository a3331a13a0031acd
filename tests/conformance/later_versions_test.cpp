// SPDX-License-Identifier: MIT
// Additions of versions 1.1 and 1.2 of the protocol (docs/protocol.md: W10, L13, V15; S13, L6,
// V17). They are policies of a command line, crossings of a reset, and moments between two ticks.

#include <gtest/gtest.h>

#include "pair.h"
#include "rules.h"

namespace ziggurat::network {
namespace {

using scene::DeadlineAction;
using std::chrono::milliseconds;

v1::ClientMessage hello(const std::string& robots, std::uint32_t minor,
                        const std::string& token = {}) {
  auto message = Peers::hello(robots);
  message.mutable_hello()->mutable_version()->set_minor(minor);
  message.mutable_hello()->set_session_token(token);
  return message;
}

TEST(LaterVersions, H2_TheLowerMinorVersionCounts) {
  for (const std::uint32_t minor : {0U, 1U, 2U, 3U, 7U}) {
    const SmallRun small(1);
    Peers peers(small);
    peers.say("p", hello("*", minor));
    EXPECT_EQ(peers.told("p").welcome().version().minor(), std::min(minor, 5U));
  }
}

// ---- dropped robots -----------------------------------------------------------------------------

/// "p" has robot0 to robot2, of which "lua" drops at once (0, 2), and "external" (1) holds.
struct Dropping {
  Dropping() : small(3), peers(small, config()) {
    peers.say("p", hello("*", 1));
    peers.publish(5);
    peers.inboxes.clear();
    peers.pass(milliseconds{50});
  }
  static Config config() {
    Config config = with_deadline(DeadlineAction::drop, 50);
    config.deadlines[1] = {{DeadlineAction::hold, 50, 0}, true};
    return config;
  }
  SmallRun small;
  Peers peers;
};

TEST(LaterVersions, W10_ASessionIsToldWhichOfItsRobotsWereDropped) {
  Dropping run;
  const auto& told = run.peers.inboxes["p"];
  ASSERT_EQ(told.size(), 2U);
  EXPECT_EQ(told[0].error().code(), v1::Error::DEADLINE_MISSED);
  EXPECT_FALSE(told[0].error().has_dropped());
  const v1::Error& error = told[1].error();
  EXPECT_EQ(error.code(), v1::Error::ROBOTS_DROPPED);
  EXPECT_EQ(error.severity(), v1::Error::WARNING);
  EXPECT_EQ(error.tick(), 5U);
  ASSERT_EQ(error.dropped().robots_size(), 2);
  EXPECT_EQ(error.dropped().robots(0), 0U);
  EXPECT_EQ(error.dropped().robots(1), 2U);
  EXPECT_FALSE(error.message().empty());
}

TEST(LaterVersions, W10_OnceForEachRobot) {
  Dropping run;
  run.peers.publish(6);
  run.peers.inboxes.clear();
  run.peers.pass(milliseconds{50});
  EXPECT_EQ(run.peers.told("p").error().code(), v1::Error::DEADLINE_MISSED) << "and nothing else";
}

// ---- resumed sessions ---------------------------------------------------------------------------

TEST(LaterVersions, L13_BeforeTheFirstTickNothingWasCommanded) {
  const SmallRun small(2);
  Peers peers(small);
  const auto token = peers.join("p", "robot0").session_token();
  // While the server gathers, it does not collect commands.
  receive(peers.barrier,
          {.connection = "new", .bytes = bytes_of(hello("*", 1, token), peers.encoding())},
          nullptr);
  const auto welcome = peers.told("new").welcome();
  EXPECT_TRUE(welcome.has_resumed());
  EXPECT_FALSE(welcome.resumed().has_commanded());
}

// ---- epochs and snapshots -----------------------------------------------------------------------

v1::ClientMessage command(std::uint64_t tick, std::uint64_t epoch) {
  auto message = Peers::command(tick);
  message.mutable_command()->set_epoch(epoch);
  return message;
}

v1::ServerMessage last(Peers& peers) {
  const auto messages = std::exchange(peers.inboxes["p"], {});
  return messages.empty() ? v1::ServerMessage{} : messages.back();
}

/// A supervisor that puts the world back again and again is no fault of a controller.
TEST(LaterVersions, M4_ACommandThatCrossesAResetIsNoBadMessage) {
  const SmallRun small(1);
  Peers peers(small);
  peers.say("p", hello("*", 2));
  peers.publish(9);
  std::uint64_t epoch = 0;
  for (int i = 0; i < 150; ++i, ++epoch) {
    restart(peers.barrier, {7});
    if (i % 3 == 0) peers.say("p", command(i == 0 ? 9 : 0, epoch));  // before the next Observation
    peers.publish(0);
    if (i % 3 == 1) peers.say("p", command(0, epoch));
    if (i % 3 == 2) continue;  // behind the next Reset
    const v1::Error error = last(peers).error();
    EXPECT_NE(error.severity(), v1::Error::FATAL) << i;
  }
  EXPECT_TRUE(peers.barrier.journal.take().notices.empty());
  peers.say("p", command(0, epoch));
  EXPECT_TRUE(peers.is_complete());
  peers.say("p", command(0, epoch));
  EXPECT_EQ(peers.barrier.journal.take().notices.size(), 1U) << "is told again";
}

TEST(LaterVersions, M4_NorWithoutEpochs) {
  const SmallRun small(1);
  Peers peers(small);
  peers.say("p", hello("*", 1));
  for (int i = 0; i < 150; ++i) {
    peers.publish(9);
    restart(peers.barrier, {7});
    peers.publish(0);
    peers.say("p", Peers::command(9));
    ASSERT_EQ(last(peers).error().code(), v1::Error::FUTURE_TICK) << i;
    restart(peers.barrier, {7});
  }
  EXPECT_TRUE(peers.barrier.journal.take().notices.empty());
}

/// One robot whose client can go back; at tick 5 its world goes back to tick 3, which is not
/// published yet.
struct Back {
  Back() : small(1), peers(small) {
    auto begin = hello("*", 2);
    begin.mutable_hello()->set_can_restore(true);
    peers.say("p", begin);
    token = peers.inboxes["p"].front().welcome().session_token();
    peers.publish(5);
  }
  void restore() {
    then = peers.commands;
    then.joint_targets = {0.5};
    wire::Restart back{7};
    back.snapshot = {"here", 3, &then, 1};
    restart(peers.barrier, back);
    peers.inboxes.clear();
  }
  SmallRun small;
  Peers peers;
  world::Commands then;
  std::string token;
};

TEST(LaterVersions, L13_ASessionThatIsResumedRightAfterARestoreIsToldWhatWasCommanded) {
  Back run;
  run.restore();
  // While the server gathers, it does not collect commands.
  const auto resume = [&](const std::string& peer) {
    receive(run.peers.barrier,
            {.connection = peer, .bytes = bytes_of(hello("*", 2, run.token), run.peers.encoding())},
            nullptr);
    return run.peers.told(peer).welcome();
  };
  const v1::Welcome welcome = resume("q");
  ASSERT_EQ(welcome.resumed().commanded().joint_targets_size(), 1);
  EXPECT_EQ(welcome.resumed().commanded().joint_targets(0), 0.5);
  restart(run.peers.barrier, {7});
  run.peers.inboxes.clear();
  EXPECT_FALSE(resume("new").resumed().has_commanded()) << "after a reset nothing was commanded";
  run.peers.publish(0);
  EXPECT_EQ(run.peers.told("new").observation().tick(), 0U);
}

TEST(LaterVersions, V15_ARobotThatIsBackAfterARestoreHasTheTickOfTheSnapshot) {
  Back run;
  run.restore();
  run.small.add_robot();  // of another controller
  run.small.add_robot();
  run.peers.commands.joint_targets.resize(3);
  run.peers.add_robots("/scenes/spawned.lua", run.small.observations(3));
  const v1::RobotSpawned told = run.peers.told("p").robot_spawned();
  EXPECT_EQ(told.robot(), "robot2");
  EXPECT_EQ(told.tick(), 3U);
}

TEST(LaterVersions, V16_ASessionWithoutATickYetIsNotToldOfARestore) {
  Back run;
  run.small.add_robot();
  run.peers.commands.joint_targets.resize(2);
  run.restore();
  run.peers.add_robots("/scenes/spawned.lua", run.small.observations(3));
  run.peers.say("late", hello("robot1", 2));
  ASSERT_EQ(run.peers.inboxes["late"].size(), 1U) << "the Welcome only";
  run.restore();
  EXPECT_TRUE(run.peers.inboxes["late"].empty());
}

TEST(LaterVersions, V17_OnlyASessionOf12CanSayThatItGoesBack) {
  for (const std::uint32_t minor : {0U, 1U, 2U}) {
    const SmallRun small(1);
    Peers peers(small);
    auto begin = hello("*", minor);
    begin.mutable_hello()->set_can_restore(true);
    peers.say("p", begin);
    EXPECT_EQ(robot_status(peers.barrier)[0].can_restore, minor == 2);
  }
}

}  // namespace
}  // namespace ziggurat::network
