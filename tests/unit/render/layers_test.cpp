// SPDX-License-Identifier: MIT
// Layers over the world if a view asks for them.
#include <gtest/gtest.h>

#include <set>

#include "render/font.h"
#include "small_world.h"

namespace ziggurat::render {
namespace {

using math::Quaternion;
using math::Vector3;
using testing::difference;
using testing::forward_view;
using testing::pixel;
using testing::project;
using testing::SmallWorld;

TEST(Layers, NothingIsDrawnUnlessTheViewAsksForIt) {
  SmallWorld world;
  const View view = forward_view();
  const Picture empty = world.picture(view);
  world.layout.entities.push_back({"name", {}});
  world.state.origins.push_back({{2, 0, 0}, Quaternion::Identity()});
  world.state.rays.push_back({world::Ray::Kind::proximity, 0, {2, -1, 0}, {2, 1, 0}, false});
  EXPECT_EQ(world.picture(view).rgb, empty.rgb);
}

TEST(Layers, ARayIsALineFromItsStartToItsEnd) {
  SmallWorld world;
  View view = forward_view();
  const Picture empty = world.picture(view);
  view.layers.rays = true;
  const Vector3 start(2, -0.4, 0.1), end(3, 0.5, -0.2);
  world.state.rays.push_back({world::Ray::Kind::proximity, 0, start, end, true});
  const Picture picture = world.picture(view);
  for (const double part : {0.02, 0.3, 0.7, 0.98}) {
    const auto at = project(view, start + part * (end - start));
    EXPECT_GT(difference(pixel(picture, at), pixel(empty, at)), 60) << part;
    EXPECT_GT(pixel(picture, at).red, pixel(picture, at).blue) << "it has met something";
  }
  for (const double part : {-0.1, 1.1}) {
    const auto at = project(view, start + part * (end - start));
    EXPECT_EQ(difference(pixel(picture, at), pixel(empty, at)), 0) << part;
  }
  const auto beside = project(view, start + 0.5 * (end - start) + Vector3(0, 0, 0.05));
  EXPECT_EQ(difference(pixel(picture, beside), pixel(empty, beside)), 0);
}

TEST(Layers, ARayIsHiddenBehindABodyAndCutAtTheCamera) {
  SmallWorld world;
  world.add(scene::Box{{0.1, 1, 1}}, {{2, 0, -0.5}, Quaternion::Identity()});
  View view = forward_view();
  view.layers.rays = true;
  const Picture wall = world.picture(view);
  world.state.rays = {{world::Ray::Kind::radio, 0, {3, -0.2, 0}, {3, 0.2, 0}, false}};
  EXPECT_EQ(world.picture(view).rgb, wall.rgb);
  world.state.rays = {{world::Ray::Kind::radio, 0, {-1, 0.3, 0}, {1.5, 0.3, 0}, false}};
  const Picture near = world.picture(view);
  const auto at = project(view, {1.5, 0.3, 0});
  EXPECT_GT(difference(pixel(near, at.x() - 3, at.y()), pixel(wall, at.x() - 3, at.y())), 60);
}

TEST(Layers, AFrustumHasTheEdgesOfWhatACameraCanSee) {
  SmallWorld world;
  View view = forward_view();
  view.layers.frusta = true;
  const Picture empty = world.picture(view);
  const auto carrier = world.add(scene::Sphere{0.001}, {{2, 0, 0}, Quaternion::Identity()});
  world::CameraLayout camera;
  camera.mount = {
      carrier, carrier, {{0, 0, 0}, Quaternion(0.5, -0.5, 0.5, -0.5)}};  // looks along x
  camera.near = 0.1;
  camera.far = 1;
  camera.focal_length = {100, 100};
  camera.principal_point = {50, 50};
  camera.resolution = {100, 100};
  world.layout.cameras.push_back(camera);
  const Picture picture = world.picture(view);
  // The far plane is a square with sides of 1 m, at x = 3.
  for (const Vector3& point :
       {Vector3(3, 0.5, 0.2), Vector3(3, -0.2, 0.5), Vector3(3, -0.5, -0.3)}) {
    const auto at = project(view, point);
    EXPECT_GT(difference(pixel(picture, at), pixel(empty, at)), 60) << point.transpose();
  }
  const auto inside = project(view, {3, 0.3, 0.4});
  EXPECT_EQ(difference(pixel(picture, inside), pixel(empty, inside)), 0);
}

TEST(Layers, ALabelStandsOverItsEntityInFrontOfEverything) {
  SmallWorld world;
  world.add(scene::Box{{0.1, 0.1, 0.1}}, {{3, 0, -0.2}, Quaternion::Identity()});
  world.add(scene::Box{{0.1, 1, 1}}, {{2, 0, -0.5}, Quaternion::Identity()});
  world.layout.entities[0].links = {0, 1};
  world.layout.entities[1].id = "";
  View view = forward_view();
  const Picture wall = world.picture(view);
  view.layers.labels = true;
  const Picture picture = world.picture(view);
  const auto at = project(view, {3, 0, -0.1});
  int light = 0;
  for (int v = -14; v <= 0; ++v) {
    for (int u = -10; u <= 10; ++u) {
      const auto shown = pixel(picture, at.x() + u, at.y() + v);
      light += shown.red > 240 && shown.green > 240 && shown.blue > 240;
    }
  }
  EXPECT_GT(light, 15) << "letters";
  EXPECT_EQ(difference(pixel(picture, at.x(), at.y() + 8), pixel(wall, at.x(), at.y() + 8)), 0);
}

TEST(Font, EachLetterIsAnotherOne) {
  std::set<Glyph> seen;
  for (char32_t code = U' '; code <= U'~'; ++code) {
    EXPECT_TRUE(seen.insert(glyph_of(code)).second) << static_cast<char>(code);
  }
  EXPECT_EQ(glyph_of(U'\u00e4'), glyph_of(U'\u4e00'));
  EXPECT_TRUE(seen.insert(glyph_of(U'\u00e4')).second);
}

}  // namespace
}  // namespace ziggurat::render
