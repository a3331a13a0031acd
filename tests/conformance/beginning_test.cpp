// SPDX-License-Identifier: MIT
// The rules of section 2 of docs/protocol.md, beginning a session. A test is named after its rule.

#include <gtest/gtest.h>

#include "rules.h"

namespace ziggurat::network {
namespace {

TEST(Hello, H9_AWelcomeHas64MebibytesOfDescriptions) {
  SmallRun small(4);
  const std::string long_value(std::size_t{33} << 20, 'x');
  small.layout().robots[1].params.emplace_back("route", long_value);
  small.layout().robots[3].params.emplace_back("route", long_value);
  Peers peers(small);
  peers.join("q", "robot1");
  auto hello = takeover("*");
  const v1::Error error = refused(peers, hello);
  EXPECT_EQ(error.code(), v1::Error::TOO_LARGE);
  EXPECT_EQ(error.field(), "robots");
  EXPECT_FALSE(error.retryable());
  EXPECT_TRUE(peers.inboxes["q"].empty()) << "the holder of a robot is not disturbed";
  EXPECT_EQ(peers.join("p", "robot[023]").robots_size(), 3) << "half of it fits";
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

TEST(Hello, V2_ARequestOfASessionThatHasLeftIsNotAnsweredToTheNextOne) {
  const SmallRun small(1);
  Peers peers(small);
  v1::ClientMessage supervisor = Peers::hello("");
  supervisor.mutable_hello()->clear_robots();
  supervisor.mutable_hello()->set_role(v1::ROLE_SUPERVISOR);
  peers.say("s", supervisor);
  peers.say("s", Peers::request(7));
  const std::vector<Call> calls = peers.barrier.calls.take();
  ASSERT_EQ(calls.size(), 1U);
  EXPECT_TRUE(can_hear(peers.barrier, calls[0]));
  peers.say("s", Peers::leave());
  peers.say("s", supervisor);
  EXPECT_FALSE(can_hear(peers.barrier, calls[0]));
  peers.inboxes.clear();
  answer(peers.barrier, calls[0], [](wire::Outbox& outbox) { outbox.response(7, 0); });
  EXPECT_TRUE(peers.inboxes["s"].empty());
}

TEST(Hello, K5_NoRoleTakesThePlacesOfAnother) {
  const SmallRun small(2);
  Config config;
  config.max_sessions = 2;
  config.max_supervisors = config.max_observers = 1;
  Peers peers(small, config);
  const auto of_role = [](v1::Role role) {
    auto hello = Peers::hello("*");
    hello.mutable_hello()->clear_robots();
    hello.mutable_hello()->set_role(role);
    return hello;
  };
  for (const v1::Role role : {v1::ROLE_OBSERVER, v1::ROLE_SUPERVISOR}) {
    const std::string name = v1::Role_Name(role);
    peers.say(name, of_role(role));
    EXPECT_TRUE(peers.told(name).has_welcome()) << name;
    peers.say("second " + name, of_role(role));
    EXPECT_EQ(peers.told("second " + name).refusal().error().code(), v1::Error::TOO_MANY) << name;
  }
  peers.join("q", "robot0");
  peers.join("p", "robot1");
}

TEST(Hello, K5_ThereAre256ObserversAnd64Supervisors) {
  const SmallRun small(1);
  Peers peers(small);
  for (const auto& [role, most] : {std::pair{v1::ROLE_OBSERVER, 256}, {v1::ROLE_SUPERVISOR, 64}}) {
    auto hello = Peers::hello("*");
    hello.mutable_hello()->clear_robots();
    hello.mutable_hello()->set_role(role);
    for (int i = 0; i <= most; ++i) {
      const std::string name = v1::Role_Name(role) + std::to_string(i);
      peers.say(name, hello);
      const auto told = peers.told(name);
      EXPECT_EQ(told.has_welcome(), i < most) << name;
      EXPECT_EQ(told.has_refusal(), i == most) << name;
    }
  }
  EXPECT_EQ(peers.join("p", "*").robots_size(), 1);
}

TEST(Hello, TooManyPatterns) {
  const SmallRun small(1);
  Peers peers(small);
  auto hello = Peers::hello("*");
  for (int i = 0; i < 64; ++i) hello.mutable_hello()->add_robots("*a");
  EXPECT_EQ(refused(peers, hello).code(), v1::Error::TOO_MANY);
}

}  // namespace
}  // namespace ziggurat::network
