// SPDX-License-Identifier: MIT
#include "network/barrier/connections.h"

#include <gtest/gtest.h>

#include <string>

namespace ziggurat::network {
namespace {

using namespace std::chrono_literals;

constexpr Rate rate{.per_second = 100, .at_once = 2};
constexpr SessionId session{1};

TEST(Connections, AreForgottenWhenTheyMaySendTheirFullAmountAgain) {
  Connections connections(rate, 100'000);
  Time now{};
  std::size_t most = 0;
  for (int each = 0; each < 10'000; ++each, now += 1ms) {
    Connection& connection = connections.receive_from(std::to_string(each), now);
    ASSERT_EQ(connections.spend(connection, now), Connections::Verdict::accepted);
    most = std::max(most, connections.size());
  }
  EXPECT_LE(most, 64u);
}

TEST(Connections, AreKeptWhileTheySendTooMuch) {
  Connections connections(rate, 100'000);
  Time now{};
  for (int each = 0; each < 1'000; ++each) {
    connections.receive_from(std::to_string(each), now);
    Connection& flooding = connections.receive_from("flooding", now);
    const auto verdict = connections.spend(flooding, now);
    ASSERT_EQ(verdict == Connections::Verdict::accepted, each < 2);
  }
}

TEST(Connections, OfASessionAreNeverForgotten) {
  Connections connections(rate, 10);
  Time now{};
  connections.receive_from("member", now);
  connections.bind("member", session);
  for (int each = 0; each < 1'000; ++each, now += 1s) {
    connections.receive_from(std::to_string(each), now);
    ASSERT_LE(connections.size(), 10u);
  }
  EXPECT_EQ(connections.session_of("member"), session);
}

TEST(Connections, WithoutASessionAreForgottenAtTheLimit) {
  Connections connections(rate, 10);
  for (int each = 0; each < 1'000; ++each) {
    Connection& connection = connections.receive_from(std::to_string(each), Time{});
    connections.spend(connection, Time{});
    ASSERT_LE(connections.size(), 10u);
  }
}

}  // namespace
}  // namespace ziggurat::network
