// SPDX-License-Identifier: MIT
// Tags and LEDs in pictures.

#include <gtest/gtest.h>

#include <cmath>

#include "detector.h"
#include "math/random.h"
#include "small_world.h"

namespace ziggurat::render {
namespace {

using math::Pose;
using math::Quaternion;
using math::Vector3;
using testing::Detector;
using testing::forward_view;
using testing::pixel;
using testing::project;
using testing::SmallWorld;

/// The corners 1, 2, 3, 4 of a tag in W [m].
std::array<Vector3, 4> corners(const Pose& tag, double side_length) {
  const double h = side_length / 2;
  return {tag * Vector3(-h, -h, 0), tag * Vector3(-h, h, 0), tag * Vector3(h, h, 0),
          tag * Vector3(h, -h, 0)};
}

Quaternion turn(double angle, const Vector3& axis) {
  return Quaternion(Eigen::AngleAxisd(angle, axis));
}

/// A frame whose z axis points to the camera of forward_view().
Quaternion facing() { return turn(-M_PI / 2, Vector3::UnitY()); }

TEST(TagInAPicture, IsFoundByARealDetectorAtItsPose) {
  Detector detector;
  const View view = forward_view(640, 480, 600);
  // Exactly on the upper face of a thin box.
  SmallWorld world;
  const auto link = world.add(scene::Box{{0.2, 0.2, 0.02}}, {});
  const Pose on_top{{0, 0, 0.02}, Quaternion::Identity()};
  world.add_tag(link, on_top, 0.12, "");
  Renderer renderer(world.scene, world.entities, world.layout);
  Picture picture;
  for (const unsigned id : {0u, 1u, 235u, 586u}) {
    for (const double tilt : {0.0, 0.6, -0.9}) {
      for (const double spin : {0.0, 1.0, 2.2, -1.7}) {
        const Pose box{{1, 0.1, 0.05},
                       turn(tilt, Vector3(0, 0.6, 0.8)) * facing() * turn(spin, Vector3::UnitZ())};
        world.state.links[link].pose = box;
        world.state.tag_payloads[0] = std::to_string(id);
        renderer.draw(world.state, view, picture);
        const auto found = detector.detect(picture);
        ASSERT_EQ(found.size(), 1u) << id << ", " << tilt << ", " << spin;
        EXPECT_EQ(found[0].id, static_cast<int>(id));
        const auto expected = corners(box * on_top, 0.12);
        for (std::size_t c = 0; c < 4; ++c) {
          const double miss = (found[0].corners[c] - project(view, expected[c])).norm();
          EXPECT_LT(miss, 0.7) << "id " << id << ", tilt " << tilt << ", spin " << spin
                               << ", corner " << c + 1;
        }
      }
    }
  }
}

TEST(TagInAPicture, IsWhiteIfItsPayloadIsNotTheNumberOfAPattern) {
  for (const char* payload : {"587", "hello", ""}) {
    SmallWorld world;
    const auto link =
        world.add(scene::Box{{0.02, 0.2, 0.2}}, {{1, 0, -0.1}, Quaternion::Identity()});
    world.add_tag(link, {{-0.01, 0, 0.1}, facing()}, 0.12, payload);
    const View view = forward_view(320, 240, 1000);
    const Picture picture = world.picture(view);
    // The margin is one module wide: the square ends at 0.075 m.
    for (const double at : {-0.072, -0.05, 0.0, 0.072}) {
      EXPECT_GT(pixel(picture, project(view, {0.99, at, 0.072})).green, 235) << payload;
    }
    EXPECT_LT(pixel(picture, project(view, {0.99, 0, 0.078})).green, 235) << payload;
  }
}

TEST(TagInAPicture, HidesTheSurfaceThatItLiesOn) {
  for (const double distance : {0.3, 3.0, 30.0}) {
    for (const double lift : {0.0, 0.0005}) {
      for (const double tilt : {0.0, 1.2, 1.4}) {
        SmallWorld world;
        const double side = 0.2 * distance;
        const Pose plate{{distance, 0, 0}, turn(tilt, Vector3::UnitZ()) * facing()};
        const auto link = world.add(scene::Box{{1.5 * side, 1.5 * side, 0.01}},
                                    plate * Pose{{0, 0, -0.01}, Quaternion::Identity()});
        world.add_tag(link, {{0, 0, 0.01 + lift}, Quaternion::Identity()}, side, "none");
        const View view = forward_view();
        const Picture picture = world.picture(view);
        const math::Vector2 middle = project(view, plate.position);
        for (double v = -20; v <= 20; v += 1) {
          ASSERT_GT(pixel(picture, middle.x(), middle.y() + v).green, 235)
              << "distance " << distance << ", lift " << lift << ", tilt " << tilt << ", row " << v;
        }
      }
    }
  }
}

TEST(TagInAPicture, IsInvisibleFromBehind) {
  SmallWorld world;
  const auto link = world.add(scene::Sphere{0.001}, {{1, 2, 0}, Quaternion::Identity()});
  const View view = forward_view();
  const Picture without = world.picture(view);
  world.add_tag(link, {{0, -2, 0}, turn(M_PI, Vector3::UnitZ()) * facing()}, 0.2, "7");
  EXPECT_EQ(world.picture(view).rgb, without.rgb);
}

TEST(LedInAPicture, HasItsColorAtItsPixel) {
  for (const double distance : {0.2, 1.0, 8.0}) {
    SmallWorld world;
    const auto box =
        world.add(scene::Box{{1, 1, 1}}, {{distance + 0.5, 0, -0.5}, Quaternion::Identity()});
    world.add_led(box, {-0.5, 0.02 * distance, 0.5}, 0xFF8000);
    world.add_led(box, {-0.5, -0.05 * distance, 0.5}, 0x000000);
    const View view = forward_view();
    const Picture picture = world.picture(view);
    const auto lit = pixel(picture, project(view, {distance, 0.02 * distance, 0}));
    EXPECT_NEAR(lit.red, 255, 3) << distance;
    EXPECT_NEAR(lit.green, 128, 6) << distance;
    EXPECT_NEAR(lit.blue, 0, 6) << distance;
    const auto off = pixel(picture, project(view, {distance, -0.05 * distance, 0}));
    EXPECT_LT(off.red + off.green + off.blue, 120) << distance;
  }
}

TEST(DirectionalLedInAPicture, IsVisibleFromItsFrontOnly) {
  for (const bool towards : {true, false}) {
    SmallWorld world;
    const auto link = world.add(scene::Sphere{0.001}, {{1, 2, 0}, Quaternion::Identity()});
    const Quaternion away = turn(M_PI, Vector3::UnitZ()) * facing();
    world.add_directional_led(link, {{0, -2, 0}, towards ? facing() : away}, 0x00FFFF);
    const View view = forward_view();
    const auto seen = pixel(world.picture(view), project(view, {1, 0, 0}));
    EXPECT_EQ(seen.red < 20 && seen.green > 250 && seen.blue > 250, towards);
  }
}

}  // namespace
}  // namespace ziggurat::render
