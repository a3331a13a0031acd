// SPDX-License-Identifier: MIT
#include "render/renderer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "small_world.h"

namespace ziggurat::render {
namespace {

using math::Pose;
using math::Quaternion;
using math::Vector3;
using testing::difference;
using testing::forward_view;
using testing::pixel;
using testing::project;
using testing::SmallWorld;

/// For each pixel, whether the world's bodies change it compared with an empty world.
std::vector<bool> touched(const SmallWorld& with, const View& view) {
  const Picture background = SmallWorld{}.picture(view);
  const Picture picture = with.picture(view);
  std::vector<bool> result(std::size_t{view.width} * view.height);
  for (std::size_t i = 0; i < result.size(); ++i) {
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
      if (picture.rgb[c] != background.rgb[c]) result[i] = true;
    }
  }
  return result;
}

TEST(Renderer, DrawsASphereAtItsProjection) {
  constexpr double radius = 0.3;
  for (const double y : {-0.8, 0.0, 1.1}) {
    SmallWorld world;
    world.add(scene::Sphere{radius}, {{3, y, 0.4 - radius}, Quaternion::Identity()});
    View view = forward_view();
    view.principal_point = {150.3, 131.7};
    const auto mask = touched(world, view);
    double area = 0, u = 0, v = 0;
    for (std::size_t i = 0; i < mask.size(); ++i) {
      if (!mask[i]) continue;
      area += 1;
      u += static_cast<double>(i % view.width) + 0.5;
      v += static_cast<double>(i / view.width) + 0.5;
    }
    // The outline is an ellipse; its ends on the line to the principal point are at the angles
    // alpha ± beta, and its centre is between them.
    const double off_axis = std::hypot(y, 0.4);
    const double alpha = std::atan2(off_axis, 3.0);
    const double beta = std::asin(radius / std::hypot(off_axis, 3.0));
    const double center = 300 * (std::tan(alpha + beta) + std::tan(alpha - beta)) / 2;
    const double long_axis = 300 * (std::tan(alpha + beta) - std::tan(alpha - beta)) / 2;
    const math::Vector2 at = view.principal_point + center * math::Vector2(-y, -0.4) / off_axis;
    EXPECT_NEAR(u / area, at.x(), 0.1) << "y " << y;
    EXPECT_NEAR(v / area, at.y(), 0.1) << "y " << y;
    // Its area follows from the short axis of the cone's section.
    const double slope = std::tan(beta);
    const double short_axis =
        300 * slope / std::cos(alpha) / std::sqrt(1 - std::pow(slope * std::tan(alpha), 2));
    // A partly covered pixel counts as a whole one.
    EXPECT_GT(area, M_PI * long_axis * short_axis) << "y " << y;
    EXPECT_LT(area, M_PI * (long_axis + 1) * (short_axis + 1)) << "y " << y;
  }
}

TEST(Renderer, DrawsEdgesWithSubpixelPrecision) {
  // A white wall whose left edge is at u = 100 + shift: the grey of a pixel is the covered share.
  for (double shift = 0; shift < 1; shift += 0.125) {
    SmallWorld world;
    const View view = forward_view();
    const double edge = (160 - (100 + shift)) / 300;  // y at x = 1
    const auto wall =
        world.add(scene::Box{{1, 1, 1}}, {{1.5, edge - 0.5, -0.5}, Quaternion::Identity()});
    world.add_tag(wall,
                  {{-0.5, 0, 0.5}, Quaternion(Eigen::AngleAxisd(-M_PI / 2, Vector3::UnitY()))}, 0.8,
                  "white");  // with its margin as large as the wall
    const Picture picture = world.picture(view);
    const auto full = pixel(picture, 110, 120).green, none = pixel(picture, 90, 120).green;
    const double covered =
        static_cast<double>(pixel(picture, 100, 120).green - none) / (full - none);
    EXPECT_NEAR(covered, 1 - shift, 0.13) << "shift " << shift;
  }
}

TEST(Renderer, HidesBodiesBehindOthers) {
  SmallWorld world;
  world.add(scene::Box{{0.1, 1, 1}}, {{3, 0, -0.5}, Quaternion::Identity()});
  const View view = forward_view();
  const Picture wall = world.picture(view);
  const auto led = world.add(scene::Sphere{0.01}, {{3.5, 0, 0}, Quaternion::Identity()});
  world.add_led(led, {0, 0, 0}, 0x00FF00);
  EXPECT_EQ(world.picture(view).rgb, wall.rgb);
}

TEST(Renderer, DoesNotDrawABodyAroundTheCamera) {
  SmallWorld world;
  const View view = forward_view();
  const Picture empty = world.picture(view);
  world.add(scene::Box{{1, 1, 1}}, {{0, 0, -0.5}, Quaternion::Identity()});
  EXPECT_EQ(world.picture(view).rgb, empty.rgb);
}

TEST(Renderer, DrawsNearAndFar) {
  // Boxes at 10 km and at 5 cm that have the same size in the picture.
  for (const double distance : {0.05, 10e3}) {
    SmallWorld world;
    const View view = forward_view();
    const double side = 0.1 * distance;
    const Picture empty = world.picture(view);
    world.add(scene::Box{{side, side, side}},
              {{distance + side / 2, 0, -side / 2}, Quaternion::Identity()});
    const Picture picture = world.picture(view);
    EXPECT_GT(difference(pixel(picture, 160, 120), pixel(empty, 160, 120)), 30) << distance;
    EXPECT_GT(difference(pixel(picture, 146, 120), pixel(empty, 146, 120)), 30) << distance;
    EXPECT_EQ(difference(pixel(picture, 144, 120), pixel(empty, 144, 120)), 0) << distance;
  }
}

TEST(Renderer, DrawsLargePicturesInTilesWithoutSeams) {
  SmallWorld world;
  world.scene.physics.floor.emplace();
  world.add(scene::Cylinder{0.2, 0.5}, {{3, -1.72, -0.3}, Quaternion::Identity()});
  View large = forward_view(1100, 60, 300);
  large.camera.position.z() = 0.2;
  View part = large;
  part.width = 200;  // columns 900 to 1100 of the large picture, across the seam at 1024
  part.principal_point.x() -= 900;
  const Picture whole = world.picture(large), piece = world.picture(part);
  for (unsigned v = 0; v < 60; ++v) {
    for (unsigned u = 0; u < 200; ++u) {
      ASSERT_LE(difference(pixel(whole, 900 + u, v), pixel(piece, u, v)), 24) << u << ", " << v;
    }
  }
}

TEST(Renderer, GivesTheSameBytesAgain) {
  SmallWorld world;
  world.scene.physics.floor.emplace();
  const auto box =
      world.add(scene::Box{{0.2, 0.3, 0.4}}, {{2, 0.1, -0.5}, Quaternion(0.8, 0, 0, 0.6)});
  world.add_led(box, {0, 0, 0.4}, 0xFF0000);
  const View view = forward_view(), other = forward_view(100, 300, 90);
  Renderer renderer(world.scene, world.entities, world.layout);
  Picture first, between, again;
  renderer.draw(world.state, view, first);
  renderer.draw(world.state, other, between);
  renderer.draw(world.state, view, again);
  EXPECT_EQ(first.rgb.size(), 320u * 240u * 3u);
  EXPECT_EQ(between.rgb.size(), 100u * 300u * 3u);
  EXPECT_EQ(first.rgb, again.rgb);
  EXPECT_EQ(world.picture(view).rgb, first.rgb) << "another renderer";
}

TEST(Renderer, DrawsTheGroundOfAPlaneAsTheFloor) {
  SmallWorld world;
  world.add(scene::Box{{0.2, 0.3, 0.4}}, {{2, 0.1, 0}, Quaternion::Identity()});
  View view = forward_view();
  view.camera.position.z() = 0.3;
  const Picture nothing = world.picture(view);
  world.scene.physics.planes.push_back({.elevation = 0.1});
  EXPECT_EQ(world.picture(view).rgb, nothing.rgb) << "a floor is drawn at z = 0 only";
  world.scene.physics.planes.push_back({});
  const Picture ground = world.picture(view);
  EXPECT_NE(ground.rgb, nothing.rgb);
  world.scene.physics.floor.emplace();
  EXPECT_EQ(world.picture(view).rgb, ground.rgb);
}

TEST(Renderer, ThrowsAShadow) {
  SmallWorld world;
  world.scene.physics.floor.emplace();
  View view = forward_view();
  view.camera = look_at({0, 0, 5}, {0, 0, 0});  // from above
  const Picture empty = world.picture(view);
  world.add(scene::Box{{0.4, 0.4, 0.4}}, {{0, 0, 0.6}, Quaternion::Identity()});
  const Picture picture = world.picture(view);
  // The sun is in the direction (-0.42, -0.62, 1.15): the shadow of z = 0.8 is displaced by
  // 0.7 times its horizontal part.
  const auto shadow = project(view, Vector3(0.42, 0.62, 0) * 0.8 / 1.15);
  const auto light = project(view, Vector3(-0.42, -0.62, 0) * 0.8 / 1.15);
  EXPECT_LT(pixel(picture, shadow).green, pixel(empty, shadow).green - 30);
  EXPECT_EQ(difference(pixel(picture, light), pixel(empty, light)), 0);
}

TEST(Renderer, ColoursTheFloorAsItsPictureAndWhatWasPaintedOverIt) {
  SmallWorld world;
  world.scene.physics.floor.emplace();
  world.scene.arena.size = {4, 4, 1};
  View view = forward_view();
  view.camera = look_at({-2, 0, 2}, {0, 0, 0});
  const auto at = [&](const Picture& picture, double x, double y) {
    return pixel(picture, project(view, {x, y, 0}));
  };
  const testing::Pixel plain = at(world.picture(view), 0.5, 0);
  world.state.floor = {{{0.5, 0}, {0.3, 0.3}, true, 0x0000FF}};
  const Picture painted = world.picture(view);
  EXPECT_GT(at(painted, 0.5, 0).blue, 2 * at(painted, 0.5, 0).red);
  EXPECT_LT(difference(at(painted, 0.5, 0.35), plain), 30) << "beside the disc";
  // Two pixels: red where x < 0, green beyond.
  world.scene.floor_image =
      std::make_shared<const images::Image>(images::Image{2, 1, {255, 0, 0, 0, 255, 0}});
  const Picture all = world.picture(view);
  EXPECT_GT(at(all, -0.5, 0.2).red, 2 * at(all, -0.5, 0.2).green);
  EXPECT_GT(at(all, 0.5, 0.35).green, 2 * at(all, 0.5, 0.35).red);
  EXPECT_GT(at(all, 0.5, 0).blue, 2 * at(all, 0.5, 0).green);
}

TEST(Renderer, ColoursTheFloorAnewWhenItChanges) {
  SmallWorld world;
  world.scene.physics.floor.emplace();
  world.scene.arena.size = {4, 4, 1};
  View view = forward_view();
  view.camera = look_at({-2, 0, 2}, {0, 0, 0});
  Renderer renderer(world.scene, world.entities, world.layout);
  Picture picture;
  const auto center = project(view, {0, 0, 0});
  world.state.floor = {{{0, 0}, {1, 1}, false, 0xFF0000}};
  renderer.draw(world.state, view, picture);
  EXPECT_GT(pixel(picture, center).red, 2 * pixel(picture, center).green);
  world.state.floor = {{{0, 0}, {1, 1}, false, 0x00FF00}};
  renderer.draw(world.state, view, picture);
  EXPECT_GT(pixel(picture, center).green, 2 * pixel(picture, center).red);
  world.state.floor.clear();
  renderer.draw(world.state, view, picture);
  EXPECT_EQ(picture.rgb, world.picture(view).rgb) << "of a world that was put back";
}

}  // namespace
}  // namespace ziggurat::render
