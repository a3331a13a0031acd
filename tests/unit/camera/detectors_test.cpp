// SPDX-License-Identifier: MIT
#include "camera/detectors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace ziggurat::camera {
namespace {

using math::Vector2;
using math::Vector3;

constexpr double pi = std::numbers::pi;

/// One camera at the origin that looks along +x of W, with v downwards, and the devices around it.
struct Stage {
  world::Layout layout;
  world::State state;
  std::vector<std::size_t> found;
  int rays = 0;

  Stage() {
    world::CameraLayout camera;
    camera.mount = place({{0, 0, 0}, looking_along_x()});
    camera.near = 0.05;
    camera.far = 1;
    camera.focal_length = {800, 800};
    camera.principal_point = {320, 240};
    camera.resolution = {640, 480};
    camera.leds = camera.directional_leds = camera.tags = world::DetectorLayout{};
    layout.cameras.push_back(camera);
  }

  static math::Quaternion looking_along_x() {
    math::Quaternion::RotationMatrixType axes;  // columns: right, down, forward
    axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    return math::Quaternion(axes);
  }
  /// Orientation of a device that points along -x of W, at the camera.
  static math::Quaternion towards_camera() {
    return math::Quaternion(Eigen::AngleAxisd(-M_PI / 2, Vector3::UnitY()));
  }

  world::Mount place(const math::Pose& pose) {
    state.origins.push_back(pose);
    return {state.origins.size() - 1, std::nullopt, {}};
  }
  void add_led(const Vector3& position, world::Color color, std::size_t medium = 0) {
    layout.leds.push_back({"", place({position, math::Quaternion::Identity()}), medium, color});
    state.led_colors.push_back(color);
  }
  void add_directional_led(const math::Pose& pose, double angle, world::Color color = 0xFF0000) {
    layout.directional_leds.push_back({"", place(pose), 0, angle, color});
    state.directional_led_colors.push_back(color);
  }
  void add_tag(const math::Pose& pose, double side, double angle = pi) {
    layout.tags.push_back({"", place(pose), 0, angle, side, ""});
    state.tag_payloads.emplace_back();
  }

  template <class Reading, class Detect>
  std::vector<Reading> look(Detect detect, const LineOfSight& clear) {
    media::DevicesIndex index(layout);
    index.build(state);
    std::vector<Reading> readings;
    detect(View(layout, state, index, 0), clear, found, readings);
    return readings;
  }
  LineOfSight counting() {
    return [this](const Vector3&, const Vector3&) { return ++rays > 0; };
  }
  auto leds() { return look<world::LedReading>(detect_leds, counting()); }
  auto directional_leds() { return look<world::LedReading>(detect_directional_leds, counting()); }
  auto tags() { return look<world::TagReading>(detect_tags, counting()); }
};

TEST(Faces, IsExactAtTheLimitOfTheAngle) {
  const math::Pose up;
  for (const double degrees : {0.0, 1e-3, 1.0, 30.0, 45.0, 89.999, 90.0, 135.0, 179.999, 180.0}) {
    const double angle = degrees * pi / 180;
    const Vector3 at(std::sin(angle), 0, std::cos(angle));
    EXPECT_TRUE(faces(up, at, angle)) << degrees;
    EXPECT_TRUE(faces(up, at * 1e-3, angle + 1e-8)) << degrees;
    if (degrees == 0) continue;
    EXPECT_FALSE(faces(up, at, angle - 1e-8)) << degrees;
  }
}

TEST(Faces, IsTrueForAll180DegreesAndOnlyOnTheAxisForZero) {
  const math::Pose device{{0.3, 0.2, 0.1}, Stage::towards_camera()};
  for (const Vector3& away : {Vector3(1, 0, 0), Vector3(-1, 0, 0), Vector3(0.3, -5, 1e-9)}) {
    EXPECT_TRUE(faces(device, device.position + away, pi));
  }
  EXPECT_TRUE(faces(device, device.position, pi));
  EXPECT_TRUE(faces(device, device.position - Vector3(0.7, 0, 0), 0));
  EXPECT_FALSE(faces(device, device.position + Vector3(0.7, 0, 0), 0));
  EXPECT_FALSE(faces(device, device.position + Vector3(-0.7, 1e-6, 0), 0));
}

TEST(DetectLeds, SkipsLedsThatAreOffOrOnAnotherMedium) {
  Stage stage;
  stage.add_led({0.5, 0, 0}, 0);
  stage.add_led({0.5, 0.01, 0}, 0xFF0000, 1);
  EXPECT_TRUE(stage.leds().empty());
  EXPECT_EQ(stage.rays, 0);
  stage.add_led({0.38, 0.01, 0.01}, 0x102030);
  const auto readings = stage.leds();
  ASSERT_EQ(readings.size(), 1u);
  EXPECT_EQ(readings[0].color, 0x102030u);
  // The dialect's example: 1 cm to the left and 1 cm up, 0.38 m ahead.
  EXPECT_NEAR(readings[0].center.x(), 298.947, 5e-4);
  EXPECT_NEAR(readings[0].center.y(), 218.947, 5e-4);
}

TEST(DetectLeds, ListsLedsInSceneOrder) {
  Stage stage;
  for (unsigned i = 0; i < 100; ++i) {
    stage.add_led({0.1 + 0.0089 * ((i * 37) % 100), 0.0001 * i, 0}, i + 1);
  }
  const auto readings = stage.leds();
  ASSERT_EQ(readings.size(), 100u);
  for (unsigned i = 0; i < 100; ++i) EXPECT_EQ(readings[i].color, i + 1);
}

TEST(DetectLeds, RangeIncludesBothLimits) {
  Stage stage;
  const double x[] = {0.05 - 1e-6, 0.05, 0.5, 1, 1 + 1e-6};
  for (unsigned i = 0; i < 5; ++i) stage.add_led({x[i], 0, 0}, i + 1);
  const auto readings = stage.leds();
  ASSERT_EQ(readings.size(), 3u);
  EXPECT_EQ(readings.front().color, 2u);
  EXPECT_EQ(readings.back().color, 4u);
}

TEST(DetectDirectionalLeds, SeesThoseThatPointAtTheCamera) {
  Stage stage;
  const math::Pose at{{0.5, 0, 0}, Stage::towards_camera()};
  stage.add_directional_led(at, pi / 4, 1);
  stage.add_directional_led({{0.5, 0, 0}, Stage::towards_camera().conjugate()}, pi / 4, 2);
  stage.add_directional_led({{0.5, 0, 0}, Stage::towards_camera().conjugate()}, pi, 3);
  stage.add_directional_led(at, pi / 4, 0);
  const auto readings = stage.directional_leds();
  ASSERT_EQ(readings.size(), 2u);
  EXPECT_EQ(readings[0].color, 1u);
  EXPECT_EQ(readings[1].color, 3u);
  EXPECT_EQ(stage.rays, 2);
}

TEST(DetectTags, ListsCornersInTheOrderOfTheTagsFrame) {
  Stage stage;
  // +z at the camera, +x up in the image, +y to its left.
  math::Quaternion::RotationMatrixType axes;  // columns: the tag's axes in W
  axes << 0, 0, -1, 0, 1, 0, 1, 0, 0;
  stage.add_tag({{0.4, 0, 0}, math::Quaternion(axes)}, 0.02);
  const auto readings = stage.tags();
  ASSERT_EQ(readings.size(), 1u);
  const double r = 800 * 0.01 / 0.4;
  const Vector2 corners[4] = {
      {320 + r, 240 + r}, {320 - r, 240 + r}, {320 - r, 240 - r}, {320 + r, 240 - r}};
  for (int i = 0; i < 4; ++i) EXPECT_NEAR((readings[0].corners[i] - corners[i]).norm(), 0, 1e-9);
  EXPECT_NEAR((readings[0].center - Vector2(320, 240)).norm(), 0, 1e-9);
}

TEST(DetectTags, NeedsAllCornersInView) {
  const auto count = [](const math::Pose& pose) {
    Stage stage;
    stage.add_tag(pose, 0.02);
    return stage.tags().size();
  };
  const math::Quaternion facing = Stage::towards_camera();
  const double edge = 0.4 * 0.5;  // of the image, at x = 0.5 m
  EXPECT_EQ(count({{0.5, edge - 0.0101, 0}, facing}), 1u);
  EXPECT_EQ(count({{0.5, edge - 0.0099, 0}, facing}), 0u);
  EXPECT_EQ(count({{1, 0, 0}, facing}), 1u);
  // Turned, so that two corners are beyond the range.
  EXPECT_EQ(count({{1, 0, 0}, facing * math::Quaternion(Eigen::AngleAxisd(0.1, Vector3::UnitX()))}),
            0u);
  EXPECT_EQ(count({{0.05, 0, 0}, facing}), 1u);
  EXPECT_EQ(
      count({{0.05, 0, 0}, facing * math::Quaternion(Eigen::AngleAxisd(0.1, Vector3::UnitY()))}),
      0u);
}

TEST(DetectTags, RejectsATagWithOneHiddenCorner) {
  for (int hidden = -1; hidden < 4; ++hidden) {
    Stage stage;
    stage.add_tag({{0.5, 0, 0}, Stage::towards_camera()}, 0.02);
    const Vector3 there =
        hidden < 0 ? Vector3(0.5, 0, 0) : tag_corners(stage.state.origins[1], 0.02)[hidden];
    const auto readings = stage.look<world::TagReading>(
        detect_tags,
        [&](const Vector3&, const Vector3& target) { return (target - there).norm() > 1e-9; });
    EXPECT_EQ(readings.size(), hidden < 0 ? 1u : 0u) << hidden;
  }
}

TEST(DetectTags, FindsAThousandLikeALinearSearch) {
  Stage stage;
  unsigned seed = 1;
  const auto random = [&](double low, double high) {
    seed = seed * 1664525 + 1013904223;
    return low + (high - low) * (seed >> 8) / 16777216.0;
  };
  for (int i = 0; i < 1000; ++i) {
    const math::Quaternion turn =
        math::Quaternion(random(-1, 1), random(-1, 1), random(-1, 1), random(-1, 1)).normalized();
    const math::Pose pose{{random(-0.2, 1.1), random(-0.6, 0.6), random(-0.4, 0.4)}, turn};
    stage.add_tag(pose, 0.02, random(0, pi));
  }
  const auto readings = stage.tags();
  std::vector<std::size_t> expected;
  const math::Pose into = math::inverse(stage.state.origins[0]);
  for (std::size_t i = 0; i < stage.layout.tags.size(); ++i) {
    const math::Pose& pose = stage.state.origins[stage.layout.tags[i].mount.entity];
    const double cosine = (pose.orientation * Vector3::UnitZ()).dot(-pose.position.normalized());
    bool seen = std::acos(cosine) <= stage.layout.tags[i].observable_angle;
    for (const Vector3& corner : tag_corners(pose, 0.02)) {
      seen = seen && in_view(stage.layout.cameras[0], into * corner);
    }
    if (seen) expected.push_back(i);
  }
  ASSERT_EQ(readings.size(), expected.size());
  EXPECT_GT(readings.size(), 20u);
  for (std::size_t i = 0; i < readings.size(); ++i) EXPECT_EQ(readings[i].tag, expected[i]);
  EXPECT_EQ(stage.rays, static_cast<int>(4 * readings.size()));
}

}  // namespace
}  // namespace ziggurat::camera
