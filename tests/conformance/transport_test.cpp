// The rules of section 1 of docs/protocol.md, transport. A test is named after its rule.

#include <gtest/gtest.h>

#include "rules.h"

namespace ziggurat::network {
namespace {

TEST(Transport, T2_GarbageIsMalformedAndDisturbsNoSession) {
  const SmallRun small(1);
  Peers peers(small);
  peers.join("p", "*");
  peers.publish(0);
  peers.inboxes.clear();
  for (const std::string& bytes : {std::string("hello"), std::string(1000, '\xff'), std::string(),
                                   std::string("\x12\x7f", 2), std::string("\x12\xff\xff", 3)}) {
    peers.send_bytes("unknown", bytes);
    const auto error = peers.told("unknown").error();
    EXPECT_EQ(error.code(), v1::Error::MALFORMED);
    EXPECT_EQ(error.severity(), v1::Error::FATAL);
  }
  EXPECT_TRUE(peers.told("p").message_case() == v1::ServerMessage::MESSAGE_NOT_SET);
  peers.say("p", Peers::command(0));
  EXPECT_TRUE(peers.is_complete());
}

TEST(Transport, T4_TooLarge) {
  const SmallRun small(1);
  Config config;
  config.max_message_bytes = 1000;
  Peers peers(small, config);
  EXPECT_EQ(peers.join("p", "*").max_message_bytes(), 1000U);
  peers.publish(0);
  peers.inboxes.clear();
  auto command = Peers::command(0);
  command.mutable_command()->add_log()->set_text(std::string(1000, 'x'));
  EXPECT_EQ(faulted(peers, command).code(), v1::Error::TOO_LARGE);
}

TEST(Transport, T4_AControllerMaySendWhatItsRobotsNeed) {
  SmallRun small(3);
  Peers peers(small);
  const auto most = peers.join("p", "robot0").max_message_bytes();
  const std::uint64_t shared = talks_json() ? 64 << 10 : 512 << 10;
  EXPECT_GE(most, shared);
  EXPECT_LT(most, shared + (64 << 10));
  small.layout().radios.resize(2);
  small.layout().radios[1].sends = true;
  small.layout().robots[1].radios = {0, 1};
  EXPECT_LT(peers.join("q", "robot1").max_message_bytes(), shared + (64 << 10)) << "it can't send";
  small.layout().robots[2].radios = {1, 1};
  EXPECT_GE(peers.join("r", "robot2").max_message_bytes(), shared + (talks_json() ? 128 << 10 : 2 << 20));
}

TEST(Transport, T5_UnknownFieldsAreIgnored) {
  const SmallRun small(1);
  Peers peers(small);
  peers.join("p", "*");
  peers.publish(0);
  // Field 15 of Command, which this version does not have, inside ClientMessage.command.
  const std::string binary("\x12\x02\x78\x01", 4);
  peers.send_bytes("p", talks_json() ? R"({"command":{"of_a_later_version":1}})" : binary);
  EXPECT_TRUE(peers.is_complete());
}

}  // namespace
}  // namespace ziggurat::network
