// SPDX-License-Identifier: MIT
// The rules of docs/protocol.md on clients that come while the world is loading: T9, H12, and what
// section 4 says of HELLO. On sockets: tests/unit/network/loading_test.cpp.

#include <gtest/gtest.h>

#include "network/peers.h"

namespace ziggurat::network {
namespace {

using std::chrono::milliseconds;

struct Loading : ::testing::Test {
  explicit Loading(const Config& config = {})
      : small(2), peers(small, config, Peers::World::loading) {
    peers.barrier.progress = {0.5, "half of it is there"};
  }
  v1::Error refused(const std::string& peer) { return peers.told(peer).refusal().error(); }

  SmallRun small;
  Peers peers;
};

TEST_F(Loading, H12_ToldAgainAboutEverySecond) {
  peers.say("p", Peers::hello("*"));
  peers.inboxes.clear();
  for (int i = 0; i < 50; ++i) peers.pass(milliseconds{100});
  EXPECT_EQ(peers.inboxes["p"].size(), 5U);
  for (const auto& message : peers.inboxes["p"]) EXPECT_TRUE(message.has_loading());
}

TEST_F(Loading, H12_InTheOrderOfArrival) {
  peers.say("first", Peers::hello("*"));
  peers.say("second", Peers::hello("*"));
  peers.inboxes.clear();
  peers.open();
  ASSERT_GE(peers.inboxes["first"].size(), 2U);
  EXPECT_TRUE(peers.inboxes["first"][1].has_welcome());
  EXPECT_EQ(peers.inboxes["second"].back().refusal().error().code(), v1::Error::ROBOT_TAKEN);
}

TEST_F(Loading, H12_RefusedIfThereIsNoWorldInTheEnd) {
  peers.say("p", Peers::hello("*"));
  peers.inboxes.clear();
  refuse_waiting(peers.barrier);
  const auto refusal = peers.told("p").refusal();
  EXPECT_EQ(refusal.error().code(), v1::Error::OUT_OF_STATE);
  EXPECT_EQ(refusal.error().severity(), v1::Error::FATAL);
  EXPECT_EQ(refusal.client_version().major(), 1U);
  EXPECT_EQ(refusal.server_version().minor(), wire::version.minor);
}

TEST_F(Loading, T9_BadMessagesInHelloAreDiscardedAndTheHelloWaits) {
  peers.send_bytes("p", "garbage");
  EXPECT_EQ(peers.told("p").error().severity(), v1::Error::FATAL) << "in NEW";
  peers.say("p", Peers::hello("*"));
  peers.inboxes.clear();
  for (const auto& message : {Peers::hello("*"), Peers::command(0), Peers::request(1)}) {
    peers.say("p", message);
    const auto error = peers.told("p").error();
    EXPECT_EQ(error.code(), v1::Error::OUT_OF_STATE);
    EXPECT_EQ(error.severity(), v1::Error::DISCARD);
  }
  peers.send_bytes("p", "garbage");
  EXPECT_EQ(peers.told("p").error().code(), v1::Error::MALFORMED);
  peers.say("p", Peers::heartbeat(7));
  EXPECT_EQ(peers.told("p").heartbeat().sequence(), 7U);
  peers.open();
  EXPECT_TRUE(peers.inboxes["p"].back().has_welcome());
}

TEST_F(Loading, M4_TooManyBadMessagesTakeTheHelloBack) {
  peers.say("p", Peers::hello("*"));
  for (int i = 0; i < 101; ++i) peers.say("p", Peers::command(0));
  EXPECT_EQ(peers.inboxes["p"].back().error().code(), v1::Error::TOO_MANY);
  EXPECT_EQ(peers.inboxes["p"].back().error().severity(), v1::Error::FATAL);
  EXPECT_EQ(peers.barrier.sessions.size(), 0U);
}

TEST_F(Loading, M7_AFloodIsToldOnce) {
  peers.say("p", Peers::hello("*"));
  for (int i = 0; i < 5000; ++i) peers.say("p", Peers::heartbeat(1));
  EXPECT_LE(peers.inboxes["p"].size(), 2002U);
  EXPECT_EQ(peers.inboxes["p"].back().error().code(), v1::Error::TOO_MANY);
  EXPECT_EQ(peers.barrier.sessions.size(), 0U);
}

TEST_F(Loading, AConnectionThatIsGoneGetsNoSession) {
  peers.say("p", Peers::hello("*"));
  peers.unreachable.insert("p");
  peers.open();
  EXPECT_FALSE(peers.is_gathered());
  EXPECT_EQ(peers.barrier.sessions.size(), 0U);
  EXPECT_TRUE(peers.take_report().notices.empty());
}

struct CrowdedLoading : Loading {
  static Config small_config() {
    Config config;
    config.max_sessions = 1;
    return config;
  }
  CrowdedLoading() : Loading(small_config()) {}
};

TEST_F(CrowdedLoading, K5_NoMoreWaitThanSessionsMay) {
  peers.say("first", Peers::hello("*"));
  EXPECT_TRUE(peers.told("first").has_loading());
  peers.say("second", Peers::hello("*"));
  const auto error = refused("second");
  EXPECT_EQ(error.code(), v1::Error::TOO_MANY);
  EXPECT_TRUE(error.retryable());
  // Observers take no place of a controller, and the other way round.
  auto observer = Peers::hello("*");
  observer.mutable_hello()->clear_robots();
  observer.mutable_hello()->set_role(v1::ROLE_OBSERVER);
  peers.say("third", observer);
  EXPECT_TRUE(peers.told("third").has_loading());
}

}  // namespace
}  // namespace ziggurat::network
