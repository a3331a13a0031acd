// SPDX-License-Identifier: MIT
// Camera readings on their way to a client.

#include "wire/device_wire.h"
#include "wire/observation.h"

namespace ziggurat::wire {
namespace {

template <typename T>
std::vector<T> list(const google::protobuf::RepeatedField<T>& values) {
  return {values.begin(), values.end()};
}

std::array<math::Vector2, 4> corners(double first) {
  return {math::Vector2{first, 1}, {first, 2}, {first, 3}, {first, 4}};
}

/// a sees an LED and two tags and takes a picture; c's cameras see one tag each, the second two
/// LEDs. c's first camera has no such detector: its LED readings are not sent.
world::Observations seen(const EquippedRun& run) {
  world::Observations seen = run.observations();
  seen.leds = {{0, 0xFF0000, {10.5, 20}},
               {1, 0x111111, {0, 0}},
               {2, 0x00FF00, {1, 2}},
               {2, 0x0000FF, {3, 4}}};
  seen.directional_leds = {{2, 0xABCDEF, {-1.5, 700}}};
  seen.tags = {{0, 2, {5, 6}, corners(10)},
               {0, 0, {7, 8}, corners(20)},
               {1, 1, {9, 9}, corners(30)},
               {2, 3, {1, 1}, corners(40)}};
  seen.images = {{0, {1, 2, 3, 4, 5, 255}}};
  return seen;
}

const std::vector<std::string> payloads{"zero", "", std::string("\0\xff", 2), "three"};

TEST_F(DeviceWire, ReadingsAreCountedPerCamera) {
  const v1::Observation to = told(seen(run), payloads);
  EXPECT_EQ(list(to.led_counts()), (std::vector<std::uint32_t>{1, 2}));
  EXPECT_EQ(list(to.led_colors()), (std::vector<std::uint32_t>{0xFF0000, 0x00FF00, 0x0000FF}));
  EXPECT_EQ(list(to.led_centers()), (std::vector<double>{10.5, 20, 1, 2, 3, 4}));
  EXPECT_EQ(list(to.directional_led_counts()), (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(list(to.directional_led_colors()), (std::vector<std::uint32_t>{0xABCDEF}));
  EXPECT_EQ(list(to.directional_led_centers()), (std::vector<double>{-1.5, 700}));
  EXPECT_EQ(list(to.tag_counts()), (std::vector<std::uint32_t>{2, 1, 1}));
  ASSERT_EQ(to.tag_payloads_size(), 4);
  EXPECT_EQ(to.tag_payloads(0), std::string("\0\xff", 2));
  EXPECT_EQ(to.tag_payloads(1), "zero");
  EXPECT_EQ(to.tag_payloads(2), "");
  EXPECT_EQ(to.tag_payloads(3), "three");
  EXPECT_EQ(list(to.tag_centers()), (std::vector<double>{5, 6, 7, 8, 9, 9, 1, 1}));
  ASSERT_EQ(to.tag_corners_size(), 4 * 8);
  EXPECT_EQ(to.tag_corners(8 + 4), 20) << "u of the third corner of the second tag";
  EXPECT_EQ(to.tag_corners(8 + 5), 3);
  ASSERT_EQ(to.camera_images_size(), 1);
  EXPECT_EQ(to.camera_images(0), "\x01\x02\x03\x04\x05\xff");
}

struct CamerasOfC : DeviceWire {
  CamerasOfC() : DeviceWire({2}) {}
};

TEST_F(CamerasOfC, OthersAreLeftOut) {
  const v1::Observation to = told(seen(run), payloads);
  EXPECT_EQ(list(to.led_counts()), (std::vector<std::uint32_t>{2}));
  EXPECT_EQ(list(to.led_colors()), (std::vector<std::uint32_t>{0x00FF00, 0x0000FF}));
  EXPECT_EQ(list(to.tag_counts()), (std::vector<std::uint32_t>{1, 1}));
  EXPECT_EQ(to.tag_payloads(1), "three");
  EXPECT_EQ(to.camera_images_size(), 0);
}

TEST_F(DeviceWire, NothingSeenIsCountedToo) {
  const v1::Observation to = told(run.observations());
  EXPECT_EQ(list(to.led_counts()), (std::vector<std::uint32_t>{0, 0}));
  EXPECT_EQ(list(to.directional_led_counts()), (std::vector<std::uint32_t>{0, 0}));
  EXPECT_EQ(list(to.tag_counts()), (std::vector<std::uint32_t>{0, 0, 0}));
  EXPECT_EQ(to.tag_centers_size() + to.led_centers_size(), 0);
  ASSERT_EQ(to.camera_images_size(), 1) << "no picture yet";
  EXPECT_EQ(to.camera_images(0), "");
}

TEST_F(DeviceWire, TagsOfManyBytesSeenOftenAreTooMuch) {
  world::Observations often = run.observations();
  const std::vector<std::string> long_payloads(4, std::string(64 << 10, 'x'));
  often.tags.assign((std::size_t{1} << 14) + 1, {1, 3, {0, 0}, corners(0)});
  Outbox outbox;
  EXPECT_FALSE(outbox.observation(roster, often, long_payloads));
  often.tags.resize(2);
  EXPECT_TRUE(outbox.observation(roster, often, long_payloads));
}

TEST_F(DeviceWire, PicturesCountToo) {
  world::Observations often = run.observations();
  const std::vector<std::string> long_payloads(4, std::string(64 << 10, 'x'));
  often.tags.assign(std::size_t{1} << 14, {1, 3, {0, 0}, corners(0)});  // the most that is allowed
  often.images = {{0, {1, 2, 3, 4, 5, 6}}};
  Outbox outbox;
  EXPECT_FALSE(outbox.observation(roster, often, long_payloads));
}

TEST_F(DeviceWire, WelcomeDescribesCameras) {
  Outbox outbox;
  outbox.welcome(run.run(), roster, Welcome{"token", 0, Role::controller, 0, 0, {}});
  const auto welcome = told(outbox).welcome();
  EXPECT_EQ(welcome.robots(1).cameras_size(), 0);
  ASSERT_EQ(welcome.robots(0).cameras_size(), 1);
  const v1::CameraDescription& camera = welcome.robots(0).cameras(0);
  EXPECT_EQ(camera.id(), "camera0");
  EXPECT_EQ(camera.anchor(), "base");
  EXPECT_EQ(list(camera.position()), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(list(camera.orientation()), (std::vector<double>{0.5, -0.5, 0.5, -0.5}));
  EXPECT_EQ(camera.near(), 0.1);
  EXPECT_EQ(camera.far(), 2);
  EXPECT_EQ(list(camera.focal_length()), (std::vector<double>{800, 900}));
  EXPECT_EQ(list(camera.principal_point()), (std::vector<double>{320, 240}));
  EXPECT_EQ(camera.width(), 2U);
  EXPECT_EQ(camera.height(), 1U);
  EXPECT_TRUE(camera.detects_leds() && camera.detects_tags() && camera.image());
  EXPECT_FALSE(camera.detects_directional_leds());
  ASSERT_EQ(welcome.robots(2).cameras_size(), 2);
  EXPECT_EQ(welcome.robots(2).cameras(1).id(), "camera2");
  EXPECT_EQ(welcome.robots(2).cameras(1).anchor(), "origin");
  EXPECT_FALSE(welcome.robots(2).cameras(0).detects_leds());
}

}  // namespace
}  // namespace ziggurat::wire
