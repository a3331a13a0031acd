// SPDX-License-Identifier: MIT
// The rules of docs/protocol.md on leases and tokens (section 5). A test is named after the rule it
// holds.

#include <gtest/gtest.h>

#include "pair.h"
#include "rules.h"

namespace ziggurat::network {
namespace {

using std::chrono::milliseconds;
using Membership = RobotStatus::Membership;

struct Lease : ::testing::Test {
  Lease() : small(2), peers(small, config()) {
    token = peers.join("old", "robot0").session_token();
    peers.join("q", "robot1");
    peers.publish(3);
    peers.say("q", Peers::command(3));
    peers.unreachable.insert("old");
    peers.probe();
    peers.inboxes.clear();
  }
  static Config config() {
    Config config;
    config.lease = milliseconds{10'000};
    return config;
  }
  SmallRun small;
  Peers peers;
  std::string token;
};

TEST_F(Lease, L7_EndsWithTime) {
  peers.pass(milliseconds{9'999});
  peers.say("new", Peers::hello("robot0"));
  EXPECT_EQ(peers.told("new").refusal().error().code(), v1::Error::ROBOT_TAKEN);
  peers.pass(milliseconds{1});
  EXPECT_EQ(peers.join("new", "robot0").robots_size() + 0, 0) << "Observation follows Welcome";
  EXPECT_EQ(peers.status()[0].membership, Membership::held);
  peers.say("back", with_token(token));
  EXPECT_EQ(peers.told("back").refusal().error().code(), v1::Error::NO_SUCH_SESSION);
}

TEST_F(Lease, L7_TheTokenStaysValidUntilAnotherSessionHasTheRobots) {
  peers.pass(milliseconds{100'000});
  peers.inboxes.clear();
  peers.say("back", with_token(token));
  EXPECT_TRUE(peers.inboxes["back"].front().has_welcome());
}

TEST(Resume, L9_AnAnswerOfBeforeIsReplacedNotRepeated) {
  SmallRun small(1);
  small.layout().robots[0].radios = {0, 1};
  small.layout().radios.resize(1);
  small.layout().radios[0].sends = true;
  Peers peers(small);
  const std::string token = peers.join("old", "*").session_token();
  peers.publish(3);
  auto command = Peers::command(3, {5});
  command.mutable_command()->add_radio_messages()->set_payload("once");
  peers.say("old", command);
  EXPECT_TRUE(peers.is_complete());
  peers.unreachable.insert("old");
  peers.probe();
  peers.say("back", with_token(token));
  peers.say("back", command);
  EXPECT_TRUE(peers.is_complete());
  EXPECT_EQ(peers.commands.radio_messages.entries.size(), 1U);
  EXPECT_EQ(peers.commands.radio_messages.bytes.size(), 4U)
      << "a client may do that again and again";
  peers.inboxes.clear();
  peers.say("back", command);
  EXPECT_EQ(peers.told("back").error().code(), v1::Error::DUPLICATE_TICK);
}

TEST(Sessions, ThousandsComeAndGo) {
  const SmallRun small(3);
  Config config;
  config.max_sessions = 4;
  config.max_supervisors = config.max_observers = config.max_directors = 0;
  config.lease = milliseconds{1};
  Peers peers(small, config);
  peers.publish(0);
  for (int i = 0; i < 3000; ++i) {
    const std::string peer = "peer" + std::to_string(i);
    peers.say(peer, Peers::hello("robot" + std::to_string(i % 3)));
    ASSERT_TRUE(peers.inboxes[peer].front().has_welcome()) << i;
    peers.unreachable = {peer};
    peers.probe();
    peers.inboxes.clear();
  }
  EXPECT_LE(peers.barrier.sessions.size(), 3U);
  EXPECT_LE(peers.barrier.connections.size(), 8U);
}

}  // namespace
}  // namespace ziggurat::network
