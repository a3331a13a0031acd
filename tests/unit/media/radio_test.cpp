// SPDX-License-Identifier: MIT
#include "media/radio.h"

#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "scattered_devices.h"

namespace ziggurat::media {
namespace {

using testing::Scattered;
using Sent = std::vector<std::pair<std::size_t, std::string>>;      // sender, text
using Received = std::vector<std::pair<std::size_t, std::string>>;  // receiver, text

void send(world::RadioMessages& messages, std::size_t radio, const std::string& text) {
  messages.add(radio, std::vector<std::uint8_t>(text.begin(), text.end()));
}

Received deliver(const Scattered& world, const Sent& sent, RadioMedium& medium) {
  world::RadioMessages out, in;
  for (const auto& [radio, text] : sent) send(out, radio, text);
  medium.deliver(world.layout, world.index(), out, in);
  EXPECT_TRUE(out.entries.empty());
  EXPECT_TRUE(out.bytes.empty());
  Received received;
  for (const auto& entry : in.entries) {
    const auto payload = in.payload(entry);
    received.emplace_back(entry.radio, std::string(payload.begin(), payload.end()));
  }
  return received;
}

Received deliver(const Scattered& world, const Sent& sent) {
  RadioMedium medium;
  return deliver(world, sent, medium);
}

TEST(Radio, ReachesReceiversStrictlyWithinTheSendersRange) {
  for (const double x : {0.0, 0.8, -3.1, 1000.3}) {
    Scattered world;
    const auto sender = world.add_radio({x, 0, 0}, 0.3);
    world.add_radio({x + 0.3 - 1e-6, 0, 0}, 1e-3);
    world.add_radio({x + 0.3, 0, 0}, 1e3);
    world.add_radio({x - 0.3, 0, 0}, 1e3);
    world.add_radio({x + 0.3 + 1e-6, 0, 0}, 1e3);
    EXPECT_EQ(deliver(world, {{sender, "a"}}), (Received{{1, "a"}})) << x;
  }
}

TEST(Radio, OrdersByReceiverSenderAndCall) {
  Scattered world;
  for (int i = 0; i < 5; ++i) world.add_radio({0.1 * i, 0, 0}, 10);
  const Received expected{{0, "1a"}, {0, "1b"}, {0, ""},   {0, "3a"}, {2, "1a"}, {2, "1b"},
                          {2, ""},   {2, "3a"}, {4, "1a"}, {4, "1b"}, {4, ""},   {4, "3a"}};
  EXPECT_EQ(deliver(world, {{1, "1a"}, {1, "1b"}, {1, ""}, {3, "3a"}}), expected);
  EXPECT_EQ(deliver(world, {{3, "3a"}, {1, "1a"}, {1, "1b"}, {1, ""}}), expected);
  EXPECT_EQ(deliver(world, {{1, "1a"}, {3, "3a"}, {1, "1b"}, {1, ""}}), expected);
}

TEST(Radio, OfTooManyMessagesTheLastOnesOfThoseThatSendMostAreLeftOut) {
  Scattered world;
  for (int i = 0; i < 5; ++i) world.add_radio({0.1 * i, 0, 0}, 10);
  const Sent sent{
      {1, "1a"}, {1, "1b"}, {1, "1c"}, {1, "1d"}, {3, "3a"}};  // to three: fifteen in all
  RadioMedium all(15), some(14), few(4), least(1);
  EXPECT_EQ(deliver(world, sent, all).size(), 15u);
  const Received cut{{0, "1a"}, {0, "1b"}, {0, "3a"}, {2, "1a"}, {2, "1b"},
                     {2, "3a"}, {4, "1a"}, {4, "1b"}, {4, "3a"}};
  EXPECT_EQ(deliver(world, sent, some), cut) << "two of each sender, and who sends few loses none";
  EXPECT_EQ(deliver(world, sent, few).size(), 4u);
  EXPECT_EQ(deliver(world, sent, least), (Received{{0, "1a"}}));

  world::RadioMessages out, in;
  for (const auto& [radio, text] : sent) send(out, radio, text);
  some.deliver(world.layout, world.index(), out, in);
  EXPECT_EQ(in.left_out, 6u);
  send(out, 1, "again");
  some.deliver(world.layout, world.index(), out, in);
  EXPECT_EQ(in.left_out, 0u);
}

TEST(Radio, ReceivesNothingInATickInWhichItSends) {
  Scattered world;
  for (int i = 0; i < 3; ++i) world.add_radio({0.1 * i, 0, 0}, 10);
  EXPECT_EQ(deliver(world, {{0, "x"}, {1, ""}}), (Received{{2, "x"}, {2, ""}}));
  EXPECT_EQ(deliver(world, {{1, ""}, {2, ""}, {0, "x"}}), Received{});
}

TEST(Radio, ReceivesOnlyOnItsMediumAndOnlyWithASensor) {
  Scattered world;
  world.add_radio({0, 0, 0}, 10);
  world.add_radio({0, 0, 0}, 10, 1);
  world.add_radio({0, 0, 0}, 10);
  world.layout.radios[2].receives = false;
  world.add_radio({0, 0, 0}, 10);
  EXPECT_EQ(deliver(world, {{0, "x"}}), (Received{{3, "x"}}));
}

TEST(Radio, DeliversLargeManyAndNoMessagesAndKeepsNone) {
  Scattered world;
  world.add_radio({0, 0, 0}, 1);
  world.add_radio({0.5, 0, 0}, 1);
  RadioMedium medium;
  const std::string large(65'536, 'z');
  EXPECT_EQ(deliver(world, {{0, large}}, medium), (Received{{1, large}}));
  Sent many;
  Received all;
  for (int i = 0; i < 1000; ++i) {
    many.emplace_back(1, std::to_string(i));
    all.emplace_back(0, std::to_string(i));
  }
  EXPECT_EQ(deliver(world, many, medium), all);
  EXPECT_EQ(deliver(world, {}, medium), Received{});
  EXPECT_TRUE(medium.links().empty());
}

TEST(Radio, AMessageNamesItsSender) {
  Scattered world;
  for (int i = 0; i < 4; ++i) world.add_radio({0.1 * i, 0, 0}, 10);
  world::RadioMessages out, in;
  send(out, 3, "c");
  send(out, 1, "a");
  RadioMedium medium;
  medium.deliver(world.layout, world.index(), out, in);
  std::vector<std::size_t> senders;
  for (const auto& entry : in.entries) senders.push_back(entry.sender);
  EXPECT_EQ(senders, (std::vector<std::size_t>{1, 3, 1, 3}));  // of receivers 0, 0, 2, 2
}

TEST(Radio, FollowsTheLinkItIsFixedTo) {
  Scattered world;
  world.add_radio({0, 0, 0}, 1);
  world.add_radio({9, 9, 9}, 1);
  world.state.links.resize(1);
  world.state.links[0].pose = {
      {1.5, 0, 0}, math::Quaternion(Eigen::AngleAxisd(M_PI / 2, math::Vector3::UnitZ()))};
  world.layout.radios[1].mount.link = 0;
  world.layout.radios[1].mount.pose.position = {0, 0.6, 0};  // turned: at x = 0.9
  EXPECT_EQ(deliver(world, {{0, "x"}}), (Received{{1, "x"}}));
  world.state.links[0].pose.position.x() += 0.2;
  EXPECT_EQ(deliver(world, {{0, "x"}}), Received{});
}

TEST(Radio, UsesTheSendersRangeNotTheReceivers) {
  Scattered world;
  world.add_radio({0, 0, 0}, 2);
  world.add_radio({1, 0, 0}, 0.5);
  RadioMedium medium;
  EXPECT_EQ(deliver(world, {{0, "far"}}, medium), (Received{{1, "far"}}));
  ASSERT_EQ(medium.links().size(), 1u);
  EXPECT_EQ(medium.links()[0].sender, 0u);
  EXPECT_EQ(medium.links()[0].receiver, 1u);
  EXPECT_EQ(deliver(world, {{1, "near"}}, medium), Received{});
}

}  // namespace
}  // namespace ziggurat::media
