// SPDX-License-Identifier: MIT
// The client's devices other than joints, against a server that the test scripts.

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "equipped_robots.h"
#include "fake_server.h"
#include "words_of.h"
#include "ziggurat/v1/protocol.pb.h"
#include "ziggurat/ziggurat.h"

namespace ziggurat {
namespace {

Bytes bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::string text_of(Bytes bytes) { return {bytes.begin(), bytes.end()}; }

TEST(Devices, AreDescribed) {
  FakeServer server([](FakeServer& self) {
    self.welcome(welcome());
    self.receive();
  });
  Session session(options_for(server));
  Robot& a = session.robot("a");
  EXPECT_TRUE(a.radios().empty() && a.leds().empty() && a.proximity_sensors().empty());
  EXPECT_EQ(a.range_and_bearing(), nullptr);
  EXPECT_EQ(a.positioning(), nullptr);
  EXPECT_EQ(a.battery(), nullptr);
  Robot& c = session.robot("c");
  EXPECT_EQ(c.radio("ears").range(), 0.5);
  EXPECT_TRUE(c.radio("ears").receives() && !c.radio("ears").sends());
  EXPECT_TRUE(c.radio("mouth").sends() && !c.radio("mouth").receives());
  EXPECT_EQ(c.led("rear").color(), (Color{1, 2, 3}));
  EXPECT_EQ(c.tags()[0].payload(), "start");
  EXPECT_EQ(c.magnet("magnet_0").current(), 0);
  EXPECT_EQ(c.proximity_sensors()[0].anchor(), "base");
  EXPECT_EQ(c.proximity_sensors()[0].position()[2], 3);
  EXPECT_EQ(c.proximity_sensors()[0].direction()[2], 1);
  EXPECT_EQ(c.proximity_sensors()[0].range(), 0.25);
  EXPECT_EQ(c.proximity_sensors()[0].angle(), -0.5);
  EXPECT_FALSE(session.robot("b").proximity_sensors()[0].angle());
  EXPECT_EQ(c.imus()[0].anchor(), "base");
  EXPECT_EQ(c.imu("imu").position()[2], 3);
  EXPECT_EQ(c.imu("imu").orientation()[1], 1);
  EXPECT_THROW(c.imu("gyro"), std::out_of_range);
  EXPECT_TRUE(a.imus().empty() && a.contact_sensors().empty());
  EXPECT_EQ(c.contact_sensors()[0].id(), "skin");
  EXPECT_EQ(c.range_and_bearing()->data_size(), 2U);
  EXPECT_EQ(text_of(c.range_and_bearing()->data()), std::string(2, '\0'));
  const std::string words = words_of<std::out_of_range>([&] { c.led("side"); });
  EXPECT_NE(words.find("no LED 'side'"), std::string::npos);
  EXPECT_NE(words.find("'front', 'rear'"), std::string::npos);
  EXPECT_THROW(a.radio("ears"), std::out_of_range);
}

TEST(Devices, ReadingsBelongToTheirTick) {
  FakeServer server([](FakeServer& self) {
    self.welcome(welcome());
    auto first = observation(0);
    receive(first, 2, std::string("\0\xff", 2));
    receive(first, 2, "");
    v1::RangeAndBearingPacket& packet = *first.mutable_observation()->add_range_and_bearing();
    packet.set_robot(1);
    packet.set_range(1.5);
    packet.set_horizontal_bearing(-0.5);
    packet.set_vertical_bearing(0.25);
    packet.set_data("xy");
    self.send(first);
    self.receive();
    self.send(observation(1));
    self.receive();
  });
  Session session(options_for(server));
  ASSERT_TRUE(session.next());
  Robot& b = session.robot("b");
  Robot& c = session.robot("c");
  EXPECT_EQ(b.proximity_sensors()[0].reading(), 0.25);
  EXPECT_EQ(c.proximity_sensors()[0].reading(), 0.75);
  EXPECT_EQ(c.positioning()->position[0], 7);
  EXPECT_EQ(c.positioning()->orientation[3], 13);
  EXPECT_EQ(c.battery()->available_charge, 0.5);
  EXPECT_EQ(c.battery()->time_left, 50);
  EXPECT_FALSE(b.contact_sensor("skin").touches());
  EXPECT_TRUE(c.contact_sensor("skin").touches());
  EXPECT_EQ(c.contact_sensor("skin").force(), (std::array<double, 3>{2, 3, 4}));
  EXPECT_EQ(c.contact_sensor("skin").strength(), 9);
  EXPECT_EQ(c.imu("imu").acceleration(), (std::array<double, 3>{3, 3.5, 4}));
  EXPECT_EQ(c.imu("imu").angular_velocity(), (std::array<double, 3>{4.5, 5, 5.5}));
  EXPECT_TRUE(b.radio("ears").received().empty());
  ASSERT_EQ(c.radio("ears").received().size(), 2U);
  EXPECT_EQ(text_of(c.radio("ears").received()[0]), std::string("\0\xff", 2));
  EXPECT_TRUE(c.radio("ears").received()[1].empty());
  EXPECT_TRUE(c.range_and_bearing()->packets().empty());
  ASSERT_EQ(b.range_and_bearing()->packets().size(), 1U);
  const auto& packet = b.range_and_bearing()->packets()[0];
  EXPECT_EQ(packet.range, 1.5);
  EXPECT_EQ(packet.horizontal_bearing, -0.5);
  EXPECT_EQ(packet.vertical_bearing, 0.25);
  EXPECT_EQ(text_of(packet.data), "xy");
  ASSERT_TRUE(session.next());
  EXPECT_TRUE(c.radio("ears").received().empty());
  EXPECT_TRUE(b.range_and_bearing()->packets().empty());
}

TEST(Devices, ValuesAreSentOnce) {
  FakeServer server([](FakeServer& self) {
    self.welcome(welcome());
    self.send(observation(0));
    const auto first = self.receive().command();
    ASSERT_EQ(first.led_colors_size(), 4);
    EXPECT_EQ(first.led_colors(1), 0x010203U) << "the scene's color";
    EXPECT_EQ(first.led_colors(2), 0xFF8001U);
    EXPECT_EQ(first.directional_led_colors_size(), 0);
    ASSERT_EQ(first.tag_payloads_size(), 2);
    EXPECT_EQ(first.tag_payloads(0), "start");
    EXPECT_EQ(first.tag_payloads(1), std::string("\0\xff", 2));
    ASSERT_EQ(first.magnet_currents_size(), 2);
    EXPECT_EQ(first.magnet_currents(0), -1.5);
    EXPECT_EQ(first.range_and_bearing_data(), std::string("\0\0xy", 4));
    ASSERT_EQ(first.radio_messages_size(), 3);
    EXPECT_EQ(first.radio_messages(0).radio(), 3U);
    EXPECT_EQ(first.radio_messages(0).payload(), "one");
    EXPECT_EQ(first.radio_messages(1).radio(), 1U);
    EXPECT_EQ(first.radio_messages(2).payload(), "");
    self.send(observation(1));
    const auto second = self.receive().command();
    EXPECT_EQ(second.led_colors_size() + second.tag_payloads_size() +
                  second.magnet_currents_size() + second.radio_messages_size(),
              0);
    EXPECT_EQ(second.range_and_bearing_data(), "");
    self.send(observation(2));
    const auto third = self.receive().command();
    EXPECT_EQ(third.radio_messages_size(), 1);
    EXPECT_EQ(third.led_colors_size(), 4);
    EXPECT_EQ(third.led_colors(2), 0xFF8001U) << "stays until changed";
    self.finish();
  });
  Session session(options_for(server));
  ASSERT_TRUE(session.next());
  Robot& b = session.robot("b");
  Robot& c = session.robot("c");
  c.led("front").set_color({255, 128, 1});
  EXPECT_EQ(c.led("front").color(), (Color{255, 128, 1}));
  c.tag("tag_0").set_payload(std::string("\0\xff", 2));
  b.magnet("magnet_0").set_current(-1.5);
  c.range_and_bearing()->set_data(bytes_of("xy"));
  c.radio("mouth").send(bytes_of("one"));
  b.radio("mouth").send(bytes_of("two"));
  c.radio("mouth").send({});
  ASSERT_TRUE(session.next());
  ASSERT_TRUE(session.next());
  c.led("rear").set_color({});
  c.radio("mouth").send(bytes_of("again"));
  EXPECT_FALSE(session.next());
}

TEST(Devices, RefuseInvalidValues) {
  FakeServer server([](FakeServer& self) {
    v1::ServerMessage roomy = welcome();
    roomy.mutable_welcome()->set_max_message_bytes(64 << 20);
    self.welcome(roomy);
    self.receive();
  });
  Session session(options_for(server));
  Robot& b = session.robot("b");
  EXPECT_THROW(b.radio("ears").send({}), std::logic_error);
  const std::string long_message(Radio::max_message_bytes + 1, 'x');
  EXPECT_THROW(b.radio("mouth").send(bytes_of(long_message)), std::length_error);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(b.magnet("magnet_0").set_current(nan), std::invalid_argument);
  EXPECT_THROW(b.tag("tag_0").set_payload(std::string(Tag::max_payload_bytes + 1, 'x')),
               std::length_error);
  EXPECT_THROW(b.range_and_bearing()->set_data(bytes_of("x")), std::invalid_argument);
  for (std::size_t i = 0; i < Radio::max_messages_per_robot; ++i) b.radio("mouth").send({});
  EXPECT_THROW(b.radio("mouth").send({}), std::length_error);
}

TEST(Devices, ASessionSendsAtMostAMessageFull) {
  FakeServer server([](FakeServer& self) {
    self.welcome(welcome());  // allows 8 MiB
    self.receive();
  });
  Session session(options_for(server));
  Radio& mouth = session.robot("b").radio("mouth");
  const std::string message(Radio::max_message_bytes, 'x');
  for (int i = 0; i < 3; ++i) mouth.send(bytes_of(message));
  EXPECT_THROW(mouth.send(bytes_of(message)), std::length_error);
}

TEST(Devices, AResetRestoresTheScenesValues) {
  FakeServer server([](FakeServer& self) {
    self.welcome(welcome());
    self.send(observation(0));
    self.receive();
    self.reset();
    self.send(observation(0));
    const auto command = self.receive().command();
    EXPECT_EQ(command.led_colors_size(), 0);
    EXPECT_EQ(command.radio_messages_size(), 0);
    self.finish();
  });
  Session session(options_for(server));
  Robot& b = session.robot("b");
  ASSERT_TRUE(session.next());
  b.led("rear").set_color({9, 9, 9});
  b.magnet("magnet_0").set_current(2);
  b.range_and_bearing()->set_data(bytes_of("xy"));
  ASSERT_TRUE(session.next());
  EXPECT_EQ(b.led("rear").color(), (Color{1, 2, 3}));
  EXPECT_EQ(b.magnet("magnet_0").current(), 0);
  EXPECT_EQ(text_of(b.range_and_bearing()->data()), std::string(2, '\0'));
  EXPECT_FALSE(session.next());
}

TEST(Devices, UnannouncedObservationsAreRefused) {
  const auto refused = [](const v1::ServerMessage& message, const char* words) {
    expect_refused(welcome(), message, words);
  };
  auto message = observation(0);
  message.mutable_observation()->add_proximity(1);
  refused(message, "3 proximity readings; it had announced 2");
  message = observation(0);
  message.mutable_observation()->clear_positioning();
  refused(message, "0 numbers of poses");
  message = observation(0);
  message.mutable_observation()->add_batteries(1);
  refused(message, "5 numbers of batteries");
  for (const std::uint32_t radio : {1U, 4U, ~0U}) {  // one that does not receive, two beyond
    message = observation(0);
    receive(message, radio, "x");
    refused(message, "which receives nothing");
  }
  message = observation(0);
  message.mutable_observation()->add_range_and_bearing()->set_robot(0);
  refused(message, "which receives none");
}

TEST(Devices, AnnouncedSizesAreLimited) {
  auto message = welcome();
  message.mutable_welcome()->mutable_robots(1)->mutable_range_and_bearing()->set_data_size(~0U);
  FakeServer server([message](FakeServer& self) { self.welcome(message); });
  EXPECT_TRUE(
      fails_with<ConnectionError>("range-and-bearing packets of 4294967295 bytes for robot 'b'",
                                  [&] { const Session session(options_for(server)); }));
}

}  // namespace
}  // namespace ziggurat
