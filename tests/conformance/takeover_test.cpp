// SPDX-License-Identifier: MIT
// Rule H13 of docs/protocol.md, with L4 and L10 of what is left of a session.

#include <gtest/gtest.h>

#include "rules.h"

namespace ziggurat::network {
namespace {

/// "p" holds robots 0 to 2 of four, "q" the last one; "new" takes over robots 2 and 3.
struct PartOfASession : testing::Test {
  PartOfASession() : small(4), peers(small) {
    token = peers.join("p", "robot[012]").session_token();
    peers.join("q", "robot3");
    peers.publish(2);
    peers.inboxes.clear();
  }
  void take() {
    peers.say("new", takeover("robot[23]"));
    ASSERT_EQ(peers.inboxes["new"].size(), 2U);
    EXPECT_TRUE(peers.inboxes["new"][1].has_observation());
  }
  SmallRun small;
  Peers peers;
  std::string token;
};

TEST_F(PartOfASession, H13_CommandsForRobotsThatWereTakenHaveNoEffect) {
  take();
  peers.say("new", Peers::command(2, {3, 4}));
  auto late = Peers::command(2, {1, 9});  // on its way when the robot was taken
  late.mutable_command()->add_robots(0);
  late.mutable_command()->add_robots(2);
  peers.inboxes.clear();
  peers.say("p", late);
  EXPECT_TRUE(peers.inboxes["p"].empty());
  EXPECT_TRUE(peers.is_complete());
  EXPECT_EQ(peers.commands.joint_targets, (std::vector<double>{1, 0, 3, 4}));
  peers.say("p", Peers::leave());
  EXPECT_EQ(peers.status()[2].holder, "usurper");
  EXPECT_EQ(peers.status()[3].holder, "usurper");
  peers.publish(3);
  peers.say("new", Peers::command(3, {5, 6}));
  EXPECT_TRUE(peers.is_complete());
}

TEST_F(PartOfASession, L10_ItsTokenStaysValidForTheRest) {
  take();
  peers.unreachable.insert("p");
  peers.probe();
  peers.inboxes.clear();
  peers.say("back", with_token(token));
  const auto& inbox = peers.inboxes["back"];
  ASSERT_EQ(inbox.size(), 3U);
  EXPECT_EQ(inbox[0].welcome().robots_size(), 3);
  EXPECT_EQ(inbox[1].error().code(), v1::Error::NOT_YOURS);
  EXPECT_EQ(inbox[1].error().robot(), "robot2");
  EXPECT_EQ(inbox[2].observation().tick(), 2U);
  peers.say("back", Peers::command(2, {1, 2, 9}));
  peers.say("new", Peers::command(2));
  EXPECT_TRUE(peers.is_complete());
  EXPECT_EQ(peers.commands.joint_targets[2], 0);
}

TEST_F(PartOfASession, L4_ALostOneKeepsTheRest) {
  peers.unreachable.insert("p");
  peers.probe();
  take();
  peers.say("back", with_token(token));
  EXPECT_TRUE(peers.inboxes["back"].front().has_welcome());
  EXPECT_EQ(peers.status()[1].holder, "tester");
  EXPECT_EQ(peers.status()[2].holder, "usurper");
}

}  // namespace
}  // namespace ziggurat::network
