// SPDX-License-Identifier: MIT
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
  /// A client that joins during a tick is told of it, too.
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

TEST_F(Population, V13_ItsCommandsBecomeZero) {
  peers.say("p", Peers::command(5, {1, 2}));
  remove(1);
  zero_missing(peers.barrier, peers.commands);
  EXPECT_EQ(peers.commands.joint_targets, (std::vector<double>{1, 0}));
}

TEST_F(Population, V13_IsToldTheEndOnce) {
  remove(0);
  remove(1);
  peers.inboxes.clear();
  finish(peers.barrier, {wire::EndReason::finished, "", 5});
  EXPECT_TRUE(peers.inboxes["p"].empty());
  EXPECT_NE(peers.barrier.sessions.size(), 0U);
}

TEST_F(Population, V13_AFreeOneIsNotWaitedFor) {
  spawn();
  remove(2);
  peers.say("p", Peers::command(5));
  publish(6);
  peers.say("p", Peers::command(6));
  EXPECT_TRUE(peers.is_complete());
}

TEST_F(Population, V13_ALostOneIsNotWaitedForAnyMore) {
  peers.unreachable.insert("p");
  publish(6);
  EXPECT_FALSE(peers.is_complete()) << "L4";
  const std::vector<std::size_t> lost{0, 1};
  remove_robots(peers.barrier, lost, {});
  EXPECT_TRUE(peers.is_complete());
  EXPECT_EQ(peers.take_report().notices.size(), 1U);
}

TEST_F(Population, V13_APausedWorldStandsOnceNoOtherSessionOwes) {
  pause(peers.barrier);
  EXPECT_FALSE(peers.barrier.gate.is_halted());
  remove(0);
  remove(1);
  EXPECT_TRUE(peers.barrier.gate.is_halted());
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
