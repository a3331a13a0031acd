// SPDX-License-Identifier: MIT
#pragma once
// Common parts of the tests of several sections of docs/protocol.md.

#include <gtest/gtest.h>

#include "network/peers.h"

namespace ziggurat::network {

/// Refusal that "p" gets for a Hello.
inline v1::Error refused(Peers& peers, const v1::ClientMessage& hello) {
  peers.say("p", hello);
  const v1::ServerMessage told = peers.told("p");
  EXPECT_TRUE(told.has_refusal()) << told.ShortDebugString();
  EXPECT_EQ(told.refusal().error().severity(), v1::Error::FATAL);
  EXPECT_FALSE(told.refusal().error().message().empty());
  return told.refusal().error();
}

/// Error that "p" gets for a message, which has no other effect.
inline v1::Error faulted(Peers& peers, const v1::ClientMessage& message) {
  const auto commands = peers.commands.joint_targets;
  peers.say("p", message);
  const v1::ServerMessage told = peers.told("p");
  EXPECT_TRUE(told.has_error()) << told.ShortDebugString();
  EXPECT_EQ(told.error().severity(), v1::Error::DISCARD);
  EXPECT_FALSE(told.error().message().empty());
  EXPECT_EQ(peers.commands.joint_targets, commands) << "a discarded message had effect";
  EXPECT_TRUE(peers.take_report().log.empty());
  return told.error();
}

/// A Hello that resumes a session.
inline v1::ClientMessage with_token(const std::string& token) {
  auto hello = Peers::hello("*");
  hello.mutable_hello()->set_session_token(token);
  return hello;
}

/// A Hello of another client for these robots, which sessions may hold.
inline v1::ClientMessage takeover(const std::string& robots) {
  auto hello = Peers::hello(robots);
  hello.mutable_hello()->set_client_name("usurper");
  hello.mutable_hello()->set_takeover(true);
  return hello;
}

}  // namespace ziggurat::network
