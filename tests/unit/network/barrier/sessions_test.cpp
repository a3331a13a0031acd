// SPDX-License-Identifier: MIT
#include "network/barrier/sessions.h"

#include <gtest/gtest.h>

#include "network/barrier/connections.h"

namespace ziggurat::network {
namespace {

using namespace std::chrono_literals;

Session& with_robot(Sessions& sessions, const std::string& token) {
  Session& session = sessions.add();
  session.token = token;
  session.roster.robots = {0};
  session.roster.gone = {false};
  return session;
}

TEST(Sessions, NoNumberIsUsedTwice) {
  Sessions sessions;
  const SessionId first = sessions.add().id;
  sessions.erase(first);
  EXPECT_NE(sessions.add().id, first);
  EXPECT_EQ(sessions.find(first), nullptr);
  EXPECT_EQ(sessions.find(SessionId::none), nullptr);
}

TEST(Sessions, OneMayEndWhileAllAreVisitedInTheirOrder) {
  Sessions sessions;
  for (int i = 0; i < 4; ++i) sessions.add();
  std::vector<SessionId> visited;
  sessions.for_each([&](Session& session) {
    visited.push_back(session.id);
    sessions.erase(session.id);
  });
  EXPECT_EQ(sessions.size(), 0U);
  EXPECT_EQ(visited, (std::vector{SessionId{1}, SessionId{2}, SessionId{3}, SessionId{4}}));
}

TEST(Sessions, ATokenFindsTheOneThatMayGoOn) {
  Sessions sessions;
  Session& session = with_robot(sessions, "token");
  EXPECT_EQ(sessions.with_token("token"), &session);
  EXPECT_EQ(sessions.with_token("another"), nullptr);
  session.state = SessionState::draining;
  EXPECT_EQ(sessions.with_token("token"), nullptr);
  session.state = SessionState::lost;
  EXPECT_EQ(sessions.with_token("token"), &session);
  session.roster.leave(0);
  EXPECT_EQ(sessions.with_token("token"), nullptr);
}

TEST(Sessions, LostOnesAreNotConnected) {
  Sessions sessions;
  sessions.add().state = SessionState::lost;
  sessions.add().waiting_hello.hello = "hello";
  EXPECT_EQ(sessions.connected(wire::Role::controller), 1U);
  EXPECT_EQ(sessions.waiting_bytes(), 5U);
}

TEST(Connections, ABucketOfMessagesIsRefilledByTime) {
  Connections connections({10, 2}, 100);
  const Time start{};
  Connection& peer = connections.receive_from("p", start);
  using Verdict = Connections::Verdict;
  EXPECT_EQ(connections.spend(peer, start), Verdict::accepted);
  EXPECT_EQ(connections.spend(peer, start), Verdict::accepted);
  EXPECT_EQ(connections.spend(peer, start), Verdict::refused);
  EXPECT_EQ(connections.spend(peer, start), Verdict::refused_and_told);
  EXPECT_EQ(connections.spend(peer, start + 100ms), Verdict::accepted);
  Connections::refund(peer, 0);
  EXPECT_EQ(connections.spend(peer, start + 100ms), Verdict::accepted);
  EXPECT_EQ(connections.spend(peer, start + 100ms), Verdict::refused);
}

TEST(Connections, ThoseWithoutSessionAreForgottenAndFirstTheQuietOnes) {
  Connections connections({1, 1}, 3);
  const Time start{};
  connections.receive_from("session", start);
  connections.bind("session", SessionId{1});
  connections.receive_from("quiet", start);
  connections.spend(connections.receive_from("loud", start), start);
  connections.receive_from("new", start);
  EXPECT_EQ(connections.size(), 3U);
  EXPECT_EQ(connections.find("quiet"), nullptr);
  EXPECT_NE(connections.find("loud"), nullptr);
  EXPECT_EQ(connections.session_of("session"), SessionId{1});
  connections.unbind("session");
  EXPECT_EQ(connections.session_of("session"), SessionId::none);
  for (int i = 0; i < 1000; ++i) connections.receive_from(std::to_string(i), start);
  EXPECT_LE(connections.size(), 3U);
}

}  // namespace
}  // namespace ziggurat::network
