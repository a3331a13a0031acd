// SPDX-License-Identifier: MIT
// Cameras of the client, against a server that the test scripts.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "equipped_robots.h"
#include "fake_server.h"
#include "words_of.h"
#include "ziggurat/v1/protocol.pb.h"
#include "ziggurat/ziggurat.h"

namespace ziggurat {
namespace {

using Pixel = Camera::Pixel;

TEST(Cameras, AreDescribed) {
  FakeServer server([](FakeServer& self) {
    self.welcome(welcome());
    self.receive();
  });
  Session session(options_for(server));
  EXPECT_TRUE(session.robot("a").cameras().empty());
  const Robot& c = session.robot("c");
  ASSERT_EQ(c.cameras().size(), 2U);
  const Camera& eye = c.camera("eye");
  EXPECT_EQ(&eye, &c.cameras()[0]);
  EXPECT_EQ(eye.id(), "eye");
  EXPECT_EQ(eye.anchor(), "turret");
  EXPECT_EQ(eye.position(), (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(eye.orientation(), (std::array<double, 4>{0.5, -0.5, 0.5, -0.5}));
  EXPECT_EQ(eye.near(), 0.1);
  EXPECT_EQ(eye.far(), 2);
  EXPECT_EQ(eye.focal_length(), (Pixel{800, 900}));
  EXPECT_EQ(eye.principal_point(), (Pixel{320, 240}));
  EXPECT_EQ(eye.width(), 2U);
  EXPECT_EQ(eye.height(), 1U);
  EXPECT_TRUE(eye.detects_leds() && eye.detects_directional_leds() && eye.detects_tags());
  EXPECT_TRUE(eye.takes_images());
  const Camera& lens = c.camera("lens");
  EXPECT_TRUE(lens.detects_tags() && !lens.detects_leds() && !lens.detects_directional_leds());
  EXPECT_FALSE(lens.takes_images());
  EXPECT_TRUE(eye.leds().empty() && eye.tags().empty() && eye.image().empty());
  const std::string words = words_of<std::out_of_range>([&] { c.camera("nose"); });
  EXPECT_NE(words.find("no camera 'nose'"), std::string::npos);
  EXPECT_NE(words.find("'eye', 'lens'"), std::string::npos);
}

/// b's eye sees a directional LED, c's eye two LEDs and a tag and takes a picture; c's lens sees
/// two tags.
v1::ServerMessage sight(std::uint64_t tick) {
  v1::ServerMessage message = observation(tick);
  v1::Observation& seen = *message.mutable_observation();
  seen.set_led_counts(1, 2);
  add_led(seen, 0xFF8001, 10.5, 20);
  add_led(seen, 0x0000FF, -1, 700);
  seen.set_directional_led_counts(0, 1);
  add_directional_led(seen, 0x00FF00, 3, 4);
  seen.set_tag_counts(2, 1);
  seen.set_tag_counts(3, 2);
  add_tag(seen, std::string("\0\xff", 2), 5, 6, 10);
  add_tag(seen, "", 7, 8, 20);
  add_tag(seen, "42", 9, 10, 30);
  *seen.mutable_camera_images(1) = "\x01\x02\x03\x04\x05\xff";
  return message;
}

TEST(Cameras, ReadingsBelongToTheirTick) {
  FakeServer server([](FakeServer& self) {
    self.welcome(welcome());
    self.send(sight(0));
    self.receive();
    self.send(observation(1));
    self.receive();
  });
  Session session(options_for(server));
  ASSERT_TRUE(session.next());
  const Camera& eye_of_b = session.robot("b").camera("eye");
  const Camera& eye = session.robot("c").camera("eye");
  const Camera& lens = session.robot("c").camera("lens");
  EXPECT_TRUE(eye_of_b.leds().empty() && eye_of_b.tags().empty() && eye_of_b.image().empty());
  ASSERT_EQ(eye_of_b.directional_leds().size(), 1U);
  EXPECT_EQ(eye_of_b.directional_leds()[0].color, (Color{0, 255, 0}));
  EXPECT_EQ(eye_of_b.directional_leds()[0].center, (Pixel{3, 4}));
  ASSERT_EQ(eye.leds().size(), 2U);
  EXPECT_EQ(eye.leds()[0].color, (Color{255, 128, 1}));
  EXPECT_EQ(eye.leds()[0].center, (Pixel{10.5, 20}));
  EXPECT_EQ(eye.leds()[1].center, (Pixel{-1, 700}));
  ASSERT_EQ(eye.tags().size(), 1U);
  EXPECT_EQ(eye.tags()[0].payload, std::string("\0\xff", 2));
  EXPECT_EQ(eye.tags()[0].center, (Pixel{5, 6}));
  EXPECT_EQ(eye.tags()[0].corners[0], (Pixel{10, 11}));
  EXPECT_EQ(eye.tags()[0].corners[3], (Pixel{16, 17}));
  EXPECT_EQ(std::vector<std::uint8_t>(eye.image().begin(), eye.image().end()),
            (std::vector<std::uint8_t>{1, 2, 3, 4, 5, 255}));
  ASSERT_EQ(lens.tags().size(), 2U);
  EXPECT_EQ(lens.tags()[0].payload, "");
  EXPECT_EQ(lens.tags()[1].payload, "42");
  EXPECT_EQ(lens.tags()[1].corners[1], (Pixel{32, 33}));
  ASSERT_TRUE(session.next());
  EXPECT_TRUE(eye.leds().empty() && eye.tags().empty() && eye.image().empty());
  EXPECT_TRUE(lens.tags().empty() && eye_of_b.directional_leds().empty());
}

TEST(Cameras, UnannouncedValuesAreRefused) {
  const auto refused = [](const v1::Observation& seen, const char* words) {
    v1::ServerMessage message;
    *message.mutable_observation() = seen;
    expect_refused(welcome(), message, words, [](Session& session) {
      EXPECT_TRUE(session.robot("c").camera("eye").leds().empty());
    });
  };
  const v1::Observation good = sight(0).observation();
  v1::Observation bad = good;
  bad.add_tag_counts(0);
  refused(bad, "5 counts of tags; it had announced 4");
  bad = good;
  bad.set_led_counts(0, ~0U);
  refused(bad, "2 colors of LEDs seen; it had announced 4294967297");
  bad = good;
  bad.add_led_centers(1);
  refused(bad, "5 numbers of centers of LEDs");
  bad = good;
  bad.set_directional_led_counts(1, 1);
  refused(bad, "1 colors of directional LEDs seen; it had announced 2");
  bad = good;
  bad.add_tag_payloads("x");
  refused(bad, "4 payloads of tags");
  bad = good;
  bad.mutable_tag_corners()->RemoveLast();
  refused(bad, "23 numbers of corners of tags");
  bad = good;
  bad.clear_camera_images();
  refused(bad, "0 pictures; it had announced 2");
  bad = good;
  bad.set_camera_images(0, "12345");
  refused(bad, "5 bytes of a picture; it had announced 6");
}

}  // namespace
}  // namespace ziggurat
