// SPDX-License-Identifier: MIT
// Pictures have the same bits whatever the processor has, and whatever the canvas drew before.
#include "render/canvas.h"

#include <gtest/gtest.h>

#include "small_world.h"

namespace ziggurat::render {
namespace {

using math::Quaternion;
using testing::forward_view;
using testing::SmallWorld;

/// Each shape, each mark, a painted floor, and a ray.
SmallWorld all_there_is() {
  SmallWorld world;
  world.scene.physics.floor.emplace();
  world.scene.arena.size = {4, 4, 1};
  const Quaternion turned(0.8, 0.36, 0, 0.48);
  const auto box = world.add(scene::Box{{0.3, 0.2, 0.4}}, {{2, 0.4, 0.1}, turned});
  world.add(scene::Cylinder{0.2, 0.5}, {{1.8, -0.4, 0}, Quaternion::Identity()});
  world.add(scene::Cylinder{0.1, 0.3}, {{1.5, 0, 0.2}, turned});
  world.add(scene::Sphere{0.2}, {{2.5, 0, 0}, Quaternion::Identity()});
  world.add(scene::Capsule{0.1, 0.5}, {{2, 0.9, 0.3}, turned});
  world.add(scene::Box{{3, 0.1, 0.2}}, {{0.5, -0.3, 0}, Quaternion::Identity()});  // past the eye
  world.add_tag(box, {{-0.1501, 0, 0.2}, Quaternion(0.5, -0.5, -0.5, 0.5)}, 0.15, "17");
  world.add_tag(box, {{0, 0, 0.4001}, Quaternion::Identity()}, 0.15, "no number");
  world.add_led(box, {0, 0, 0.42}, 0xFF8000);
  world.state.floor = {{{1, 0.2}, {0.4, 0.4}, true, 0x0000FF}};
  world.state.rays.push_back({world::Ray::Kind::proximity, 0, {1, -1, 0.1}, {3, 1, 0.3}, true});
  return world;
}

View view_of(unsigned oversampling) {
  View view = forward_view(317, 203, 220);
  view.camera = look_at({0, 0, 0.7}, {2, 0, 0.1});
  view.oversampling = oversampling;
  view.layers.rays = true;
  return view;
}

Picture picture_of(const SmallWorld& world, const View& view, Canvas& canvas) {
  Draftsman draftsman(make_model(world.scene, world.entities), world.layout);
  Drawing drawing;
  draftsman.draw(world.state, view, drawing);
  Picture picture;
  canvas.draw(drawing, draftsman.meshes(), draftsman.model(), view, picture);
  return picture;
}

TEST(Canvas, DrawsTheSameBitsWithAnyInstructionSet) {
  if (!avx2_kernel()) GTEST_SKIP() << "this processor has no AVX2";
  const SmallWorld world = all_there_is();
  for (const unsigned oversampling : {1u, 2u, 3u}) {
    Canvas narrow(&baseline_kernel()), wide(avx2_kernel());
    const View view = view_of(oversampling);
    EXPECT_EQ(picture_of(world, view, narrow).rgb, picture_of(world, view, wide).rgb);
  }
}

TEST(Canvas, ForgetsWhatItDrewBefore) {
  const SmallWorld world = all_there_is();
  SmallWorld other;
  other.scene.physics.floor.emplace();
  other.add(scene::Box{{1, 1, 1}}, {{1.5, 0.3, 0.2}, Quaternion::Identity()});
  Canvas used, fresh;
  picture_of(other, forward_view(600, 500, 300), used);
  EXPECT_EQ(picture_of(world, view_of(1), used).rgb, picture_of(world, view_of(1), fresh).rgb);
}

TEST(Covered, GivesEachSampleToOneOfTwoPolygonsThatShareAnEdge) {
  const Polygon::Edge left{10.3, 2.1, 17.9, 0.4}, right{31.7, 2.1, 17.9, -0.3};
  for (const double slope : {0.2, 0.45, 0.7}) {
    const Polygon::Edge middle{15, 2.1, 17.9, slope};
    Polygon whole, first, second;
    for (auto* polygon : {&whole, &first, &second}) polygon->count = 2;
    whole.edges = {left, right};
    first.edges = {left, middle};
    second.edges = {middle, right};
    for (double y = 0.125; y < 20; y += 0.25) {
      const Stretch all = covered(whole, y, 0.375, 40);
      const Stretch a = covered(first, y, 0.375, 40), b = covered(second, y, 0.375, 40);
      EXPECT_EQ(all.end - all.begin, a.end - a.begin + b.end - b.begin) << y;
      EXPECT_EQ(y >= 2.1 && y < 17.9, all.begin < all.end) << y;
    }
  }
}

}  // namespace
}  // namespace ziggurat::render
