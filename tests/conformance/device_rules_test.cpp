// SPDX-License-Identifier: MIT
// Limits of docs/protocol.md that follow from the robots of a session: T4, K5, D5. A test is named
// after its rule.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "network/peers.h"
#include "world/limits.h"

namespace ziggurat::network {
namespace {

/// Three robots with a radio each; that of robot2 only receives. "p" holds robot0 and robot2 and
/// owes tick 5, "q" holds robot1.
struct Radios : ::testing::Test {
  explicit Radios(wire::Encoding encoding = wire::Encoding::binary) : small(3), peers(equipped()) {
    peers.json = encoding == wire::Encoding::json;
    peers.join("p", "robot[02]");
    peers.join("q", "robot1");
    peers.publish(5);
    peers.inboxes.clear();
  }

  const SmallRun& equipped() {
    world::Layout& layout = small.layout();
    for (std::size_t i = 0; i < 3; ++i) {
      world::RadioLayout& radio = layout.radios.emplace_back();
      radio.id = "radio" + std::to_string(i);
      radio.sends = i != 2;
      radio.receives = true;
      layout.robots[i].radios = {i, 1};
    }
    return small;
  }
  static void send(v1::ClientMessage& command, std::uint32_t radio, const std::string& payload) {
    v1::RadioMessage& message = *command.mutable_command()->add_radio_messages();
    message.set_radio(radio);
    message.set_payload(payload);
  }
  /// So many messages of one byte are taken, 60 000 are not.
  void expect_at_most(int count) {
    auto command = Peers::command(5);
    for (int i = 0; i < 60'000; ++i) send(command, 0, "x");
    peers.say("p", command);
    EXPECT_EQ(peers.told("p").error().code(), v1::Error::TOO_LARGE);
    EXPECT_TRUE(peers.commands.radio_messages.entries.empty());
    command.mutable_command()->mutable_radio_messages()->DeleteSubrange(0, 60'000 - count);
    peers.say("p", command);
    EXPECT_EQ(peers.commands.radio_messages.entries.size(), static_cast<std::size_t>(count));
  }

  SmallRun small;
  Peers peers;
};

TEST(Transport, T4_AControllerMaySendWhatItsRobotsNeed) {
  for (const bool in_json : {false, true}) {
    SmallRun small(3);
    Peers peers(small);
    peers.json = in_json;
    const auto most = peers.join("p", "robot0").max_message_bytes();
    const std::uint64_t shared = in_json ? 64 << 10 : 512 << 10;
    EXPECT_GE(most, shared);
    EXPECT_LT(most, shared + (64 << 10));
    small.layout().radios.resize(2);
    small.layout().radios[1].sends = true;
    small.layout().robots[1].radios = {0, 1};
    EXPECT_LT(peers.join("q", "robot1").max_message_bytes(), shared + (64 << 10))
        << "it can't send";
    small.layout().robots[2].radios = {1, 1};
    EXPECT_GE(peers.join("r", "robot2").max_message_bytes(),
              shared + (in_json ? 128 << 10 : 2 << 20));
  }
}

struct RadiosInJson : Radios {
  RadiosInJson() : Radios(wire::Encoding::json) {}
};

TEST_F(Radios, K5_SmallMessagesInGreatNumbersAreTooLarge) { expect_at_most(15'000); }
TEST_F(RadiosInJson, K5_SmallMessagesInGreatNumbersAreTooLarge) { expect_at_most(1500); }

TEST_F(Radios, D5_ASessionThatWouldHearTooMuchIsLost) {
  world::Observations seen = small.observations(6);
  const std::string text(world::most_radio_message_bytes, 'x');
  seen.radio_messages.add(0, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  const auto entry = seen.radio_messages.entries.front();
  seen.radio_messages.entries.assign(1025, entry);
  peers.publish(seen);
  const auto error = peers.told("p").error();
  EXPECT_EQ(error.code(), v1::Error::TOO_LARGE);
  EXPECT_EQ(error.severity(), v1::Error::FATAL);
  const auto notices = peers.take_report().notices;
  ASSERT_EQ(notices.size(), 1U);
  EXPECT_NE(notices[0].find("is lost: its robots heard and saw more at a tick than a message can "
                            "hold; share them among more sessions"),
            std::string::npos)
      << notices[0];
  EXPECT_EQ(peers.told("q").observation().tick(), 6U);
  EXPECT_FALSE(peers.is_complete());
}

}  // namespace
}  // namespace ziggurat::network
