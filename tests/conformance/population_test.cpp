// The rules of docs/protocol.md on robots that are spawned and removed while a world runs: V9, V13
// and V14. Worlds are in tests/unit/simulation; here is what sessions are told.

#include <gtest/gtest.h>

#include "network/peers.h"

namespace ziggurat::network {
namespace {

using std::chrono::milliseconds;

/// "p" holds robot0 and robot1 and owes tick 5.
class Population : public ::testing::Test {
 protected:
  Population() : Population(Config{}) {}
  explicit Population(const Config& config) : small(2), peers(small, config) {
    peers.join("p", "*");
    publish(5);
    peers.inboxes.clear();
  }

  void publish(std::uint64_t tick) {
    published = tick;
    peers.publish(tick);
  }
  /// robot2, robot3, … come.
  void spawn() {
    small.add_robot();
    peers.commands.joint_targets.resize(small.layout().joint_actuators.size());
    const std::string script = "/scenes/spawned.lua";
    peers.add_robots(script, small.observations(published));
  }
  void remove(std::size_t robot) { remove_robots(peers.barrier, {&robot, 1}, "It was removed."); }
  /// The scene has two robots.
  void reset() {
    world::Layout& layout = small.layout();
    layout.robots.resize(2);
    layout.joint_sensors.resize(2);
    layout.joint_actuators.resize(2);
    network::restart(peers.barrier, {42});
  }
  /// A client that joins while a tick is in hand is told of it, too.
  v1::Welcome join(const std::string& peer, const std::string& robots) {
    peers.say(peer, Peers::hello(robots));
    const auto told = all_told(peer);
    return told.empty() ? v1::Welcome() : told.front().welcome();
  }
  std::vector<v1::ServerMessage> all_told(const std::string& peer) {
    return std::exchange(peers.inboxes[peer], {});
  }

  SmallRun small;
  Peers peers;
  std::uint64_t published = 0;
};

TEST_F(Population, V9_IsNotWaitedForAtTheTickInHandButAtTheNext) {
  spawn();
  peers.say("p", Peers::command(5, {1, 2}));
  EXPECT_TRUE(peers.is_complete());
  publish(6);
  peers.say("p", Peers::command(6));
  EXPECT_FALSE(peers.is_complete()) << "no session has robot2";
  EXPECT_EQ(join("q", "robot2").robots_size(), 1);
  EXPECT_FALSE(peers.is_complete());
  peers.say("q", Peers::command(6));
  EXPECT_TRUE(peers.is_complete());
}

TEST_F(Population, V9_ASessionThatTakesItGetsTheTickInHandAndIsWaitedFor) {
  spawn();
  peers.say("q", Peers::hello("robot2"));
  const auto told = all_told("q");
  ASSERT_EQ(told.size(), 2u);
  ASSERT_EQ(told[0].welcome().robots_size(), 1);
  EXPECT_EQ(told[0].welcome().robots(0).id(), "robot2");
  EXPECT_EQ(told[0].welcome().robots(0).script(), "/scenes/spawned.lua");
  EXPECT_EQ(told[1].observation().tick(), 5u);
  ASSERT_EQ(told[1].observation().joint_readings_size(), 1);
  EXPECT_EQ(told[1].observation().joint_readings(0), 502);
  peers.say("p", Peers::command(5, {1, 2}));
  EXPECT_FALSE(peers.is_complete());
  peers.say("q", Peers::command(5, {3}));
  EXPECT_TRUE(peers.is_complete());
  EXPECT_EQ(peers.commands.joint_targets, (std::vector<double>{1, 2, 3}));
}

TEST_F(Population, V9_OthersKeepTheirPositions) {
  spawn();
  peers.say("p", Peers::command(5, {1, 2}));
  publish(6);
  const auto told = peers.told("p").observation();
  ASSERT_EQ(told.joint_readings_size(), 2);
  EXPECT_EQ(told.joint_readings(1), 601);
}

TEST_F(Population, V9_BeforeTheFirstTickItIsWaitedForToo) {
  SmallRun fresh(1);
  Peers others(fresh);
  others.join("p", "*");
  ASSERT_TRUE(others.is_gathered());
  fresh.add_robot();
  others.add_robots({}, {});
  EXPECT_FALSE(others.is_gathered());
  EXPECT_EQ(others.join("q", "robot1").robots(0).id(), "robot1");
  EXPECT_TRUE(others.is_gathered());
}

class PopulationHeld : public Population {
 protected:
  static Config holding() {
    Config config;
    config.deadlines.assign(2, {{scene::DeadlineAction::hold, 50, 0}, true});
    config.heartbeat = milliseconds{100'000};
    return config;
  }
  PopulationHeld() : Population(holding()) {}
};

TEST_F(PopulationHeld, V9_ItsDeadlineRunsFromThenOn) {
  spawn();
  peers.say("p", Peers::command(5));
  publish(6);
  peers.say("p", Peers::command(6));
  EXPECT_FALSE(peers.is_complete());
  peers.pass(milliseconds{50});
  EXPECT_TRUE(peers.is_complete());
}

TEST_F(Population, V13_ASessionIsToldAndGoesOnWithTheOthers) {
  remove(0);
  const auto error = peers.told("p").error();
  EXPECT_EQ(error.code(), v1::Error::NOT_YOURS);
  EXPECT_EQ(error.severity(), v1::Error::WARNING);
  EXPECT_EQ(error.robot(), "robot0");
  EXPECT_EQ(error.tick(), 5u);
  EXPECT_FALSE(peers.is_complete()) << "it owes for robot1";
  peers.say("p", Peers::command(5, {1, 2}));
  EXPECT_TRUE(peers.is_complete());
  EXPECT_EQ(peers.commands.joint_targets, (std::vector<double>{0, 2}));
  publish(6);
  EXPECT_EQ(peers.told("p").observation().joint_readings_size(), 2) << "positions stay";
}

TEST_F(Population, V13_ItsCommandsBecomeZero) {
  peers.say("p", Peers::command(5, {1, 2}));
  remove(1);
  zero_missing(peers.barrier, peers.commands);
  EXPECT_EQ(peers.commands.joint_targets, (std::vector<double>{1, 0}));
}

TEST_F(Population, V13_ASessionWithoutRobotsIsOverAndMaySendLeave) {
  remove(0);
  peers.inboxes.clear();
  remove(1);
  EXPECT_EQ(peers.told("p").end().reason(), v1::End::FINISHED);
  EXPECT_TRUE(peers.is_complete());
  publish(6);
  EXPECT_TRUE(peers.inboxes["p"].empty());
  auto goodbye = Peers::leave();
  goodbye.mutable_leave()->add_log()->set_text("that was all");
  peers.say("p", goodbye);
  EXPECT_EQ(peers.take_report().log.at(0).text, "that was all");
  EXPECT_EQ(peers.barrier.sessions.size(), 0u);
}

TEST_F(Population, V13_IsToldTheEndOnce) {
  remove(0);
  remove(1);
  peers.inboxes.clear();
  finish(peers.barrier, {wire::EndReason::finished, "", 5});
  EXPECT_TRUE(peers.inboxes["p"].empty());
  EXPECT_NE(peers.barrier.sessions.size(), 0U);
}

TEST_F(Population, V13_ItIsGoneForGood) {
  remove(0);
  peers.say("q", Peers::hello("robot0"));
  EXPECT_EQ(peers.told("q").refusal().error().code(), v1::Error::NOT_YOURS);
}

TEST_F(Population, V13_AFreeOneIsNotWaitedFor) {
  spawn();
  remove(2);
  peers.say("p", Peers::command(5));
  publish(6);
  peers.say("p", Peers::command(6));
  EXPECT_TRUE(peers.is_complete());
}

TEST_F(Population, V13_APausedWorldStandsOnceNoOtherSessionOwes) {
  pause(peers.barrier);
  EXPECT_FALSE(peers.barrier.gate.is_standing());
  remove(0);
  remove(1);
  EXPECT_TRUE(peers.barrier.gate.is_standing());
}

TEST_F(Population, V14_ARobotThatWasSpawnedIsUnknownAfterAReset) {
  spawn();
  join("q", "robot2");
  reset();
  ASSERT_EQ(all_told("q").at(0).end().reason(), v1::End::FINISHED);
  EXPECT_TRUE(peers.told("p").has_reset());
  publish(0);
  peers.say("p", Peers::command(0));
  EXPECT_TRUE(peers.is_complete());
  peers.say("r", Peers::hello("robot2"));
  EXPECT_EQ(peers.told("r").refusal().error().code(), v1::Error::UNKNOWN_ROBOT);
  EXPECT_EQ(peers.status().size(), 2u);
}

TEST_F(Population, V14_ASessionOfSuchARobotMayStillSendLeave) {
  spawn();
  join("q", "robot2");
  reset();
  publish(0);
  peers.inboxes.clear();
  auto goodbye = Peers::leave();
  goodbye.mutable_leave()->add_log()->set_text("that was all");
  peers.say("q", Peers::command(5, {1}));
  EXPECT_TRUE(peers.inboxes["q"].empty());
  peers.say("q", goodbye);
  EXPECT_TRUE(peers.inboxes["q"].empty());
  EXPECT_TRUE(peers.take_report().log.empty());
  EXPECT_EQ(peers.barrier.sessions.size(), 1u);
}

TEST(PopulationOf, V14_SessionsThatHaveSomeEndAndTheirOtherRobotsAreFree) {
  SmallRun three(2);
  Peers others(three);
  others.join("p", "*");
  others.publish(1);
  three.add_robot();
  others.commands.joint_targets.resize(3);
  others.add_robots({}, three.observations(1));
  auto hello = Peers::hello("*");
  hello.mutable_hello()->set_takeover(true);
  others.say("q", hello);
  others.inboxes.clear();
  three.layout().robots.resize(2);
  restart(others.barrier, {42});
  EXPECT_EQ(others.told("q").end().reason(), v1::End::FINISHED);
  EXPECT_FALSE(others.is_gathered());
  EXPECT_EQ(others.join("r", "*").robots_size(), 2);
  EXPECT_TRUE(others.is_gathered());
}

TEST_F(Population, V14_LostSessionsOfSuchRobotsAreForgotten) {
  spawn();
  const auto token = join("q", "robot2").session_token();
  peers.unreachable.insert("q");
  peers.probe();
  reset();
  publish(0);
  EXPECT_EQ(peers.barrier.sessions.size(), 1u);
  auto hello = Peers::hello("*");
  hello.mutable_hello()->set_session_token(token);
  peers.say("r", hello);
  EXPECT_EQ(peers.told("r").refusal().error().code(), v1::Error::NO_SUCH_SESSION);
}

TEST_F(Population, V14_AThousandTimesLeavesNothingBehind) {
  for (int i = 0; i < 1000; ++i) {
    spawn();
    const std::string peer = "q" + std::to_string(i);
    join(peer, "robot2");
    reset();
    publish(0);
    peers.say(peer, Peers::leave());
  }
  EXPECT_EQ(peers.barrier.sessions.size(), 1u);
  EXPECT_EQ(peers.status().size(), 2u);
  peers.say("p", Peers::command(0));
  EXPECT_TRUE(peers.is_complete());
}

}  // namespace
}  // namespace ziggurat::network
