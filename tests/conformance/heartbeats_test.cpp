// SPDX-License-Identifier: MIT
// The rules of docs/protocol.md on heartbeats and rates (section 4). A test is named after the rule
// it holds.

#include <gtest/gtest.h>

#include "pair.h"

namespace ziggurat::network {
namespace {

using std::chrono::milliseconds;
using Membership = RobotStatus::Membership;

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
  for (std::uint64_t tick = 6; tick < 5000; ++tick) {
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

TEST(Rate, M7_LongCommandsThatAreNotOwedCountMoreThanOnce) {
  Pair pair{Config{}};
  pair.peers.say("p", Peers::command(5));
  auto late = Peers::command(5);
  late.mutable_command()->add_log()->set_text(std::string(64 << 10, 'x'));
  int sent = 0;
  while (pair.peers.status()[0].membership == Membership::held && sent < 1000) {
    pair.peers.say("p", late);
    ++sent;
  }
  EXPECT_LE(sent, 2000 / 5 + 2);
  EXPECT_EQ(pair.peers.inboxes["p"].back().error().code(), v1::Error::TOO_MANY);
}

TEST(Rate, M7_LongCommandsThatAreOwedAreFree) {
  Pair pair{Config{}};
  pair.peers.say("p", Peers::command(5));
  for (std::uint64_t tick = 6; tick < 60; ++tick) {
    pair.peers.publish(tick);
    auto owed = Peers::command(tick);
    owed.mutable_command()->add_log()->set_text(std::string(64 << 10, 'x'));
    pair.peers.inboxes.clear();
    pair.peers.say("p", owed);
    ASSERT_TRUE(pair.peers.inboxes["p"].empty());
    pair.peers.say("q", Peers::command(tick));
  }
}

TEST(Rate, M7_PeersWithoutASessionToo) {
  const SmallRun small(1);
  Peers peers(small);
  for (int i = 0; i < 5000; ++i) peers.send_bytes("unknown", "garbage");
  EXPECT_LE(peers.inboxes["unknown"].size(), 2001U);
  EXPECT_TRUE(peers.join("p", "*").robots_size() == 1) << "others are not affected";
}

}  // namespace
}  // namespace ziggurat::network
