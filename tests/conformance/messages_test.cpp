// The rules of section 4 of docs/protocol.md on bad messages and on peers without a session. A test
// is named after its rule.

#include <gtest/gtest.h>

#include "rules.h"

namespace ziggurat::network {
namespace {

TEST_F(Stepping, M4_BadMessagesWithoutEndAreTheEnd) {
  for (int i = 0; i < 100; ++i) {
    peers.say("p", Peers::command(77));
    EXPECT_EQ(peers.told("p").error().severity(), v1::Error::DISCARD);
  }
  peers.say("p", Peers::command(77));
  const auto error = peers.told("p").error();
  EXPECT_EQ(error.code(), v1::Error::TOO_MANY);
  EXPECT_EQ(error.severity(), v1::Error::FATAL);
  EXPECT_EQ(peers.status()[0].membership, RobotStatus::Membership::free);
}

TEST_F(Stepping, M4_AGoodMessageStartsTheCountAnew) {
  for (int i = 0; i < 90; ++i) peers.say("p", Peers::command(77));
  peers.say("p", Peers::command(5));
  peers.publish(6);
  for (int i = 0; i < 90; ++i) peers.say("p", Peers::command(77));
  EXPECT_EQ(peers.status()[0].membership, RobotStatus::Membership::held);
}

TEST(PeersWithoutSession, LeaveNothingBehind) {
  const SmallRun small(1);
  Peers peers(small);
  for (int i = 0; i < 2'000; ++i) {
    const std::string peer = "unknown" + std::to_string(i);
    peers.send_bytes(peer, "garbage");
    peers.say(peer, Peers::hello("nobody"));
    peers.inboxes.clear();
  }
  EXPECT_EQ(peers.barrier.sessions.size(), 0U);  // not one session
  EXPECT_LE(peers.take_report().notices.size(), 100U);
}

/// The terminal of the server, or the disk of its log.
TEST(PeersWithoutSession, FillNoLogWithWrongMessages) {
  const SmallRun small(1);
  Peers peers(small);
  std::vector<std::string> told;
  const auto send_many = [&] {
    for (int i = 0; i < 500; ++i) {  // each told by itself, as at ticks of its own
      peers.send_bytes("unknown" + std::to_string(i), "garbage");
      if (i % 2 == 0) peers.say("other" + std::to_string(i), Peers::hello("nobody"));
      for (const std::string& line : peers.take_report().notices) told.push_back(line);
    }
  };
  send_many();
  EXPECT_EQ(told.size(), 20U);
  peers.barrier.now += std::chrono::seconds{1};
  send_many();
  ASSERT_EQ(told.size(), 21U);
  EXPECT_TRUE(told.back().ends_with(" (730 more before it.)")) << told.back();
}

TEST(PeersWithoutSession, TheirNamesStayOneShortLine) {
  const SmallRun small(1);
  Peers peers(small);
  auto hello = Peers::hello("nobody\n" + std::string(100'000, 'x'));
  hello.mutable_hello()->set_client_name("\x1b[31m\nevil" + std::string(100'000, 'y'));
  peers.say("p", hello);
  const auto notices = peers.take_report().notices;
  ASSERT_EQ(notices.size(), 1U);
  EXPECT_LT(notices[0].size(), 1001U);
  EXPECT_EQ(notices[0].find_first_of("\n\x1b"), std::string::npos);
}

}  // namespace
}  // namespace ziggurat::network
