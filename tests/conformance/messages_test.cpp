// SPDX-License-Identifier: MIT
// Traces that peers without a session leave behind: nothing, and few lines.

#include <gtest/gtest.h>

#include "network/peers.h"

namespace ziggurat::network {
namespace {

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
