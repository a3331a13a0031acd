// SPDX-License-Identifier: MIT
#include "render/drawing.h"

#include <gtest/gtest.h>

#include "small_world.h"

namespace ziggurat::render {
namespace {

using testing::forward_view;
using testing::SmallWorld;

Drawing drawing_of(const SmallWorld& world, const View& view) {
  Draftsman draftsman(make_model(world.scene, world.entities), world.layout);
  Drawing drawing;
  draftsman.draw(world.state, view, drawing);
  return drawing;
}

std::size_t visible(const Drawing& drawing) {
  std::size_t count = 0;
  for (const Batch& batch : drawing.batches) count += batch.visible;
  return count;
}

TEST(Drawing, SkipsBodiesOutsideThePicture) {
  SmallWorld world;
  const scene::Sphere ball{0.1};
  world.add(ball, {{2, 0, -0.1}, {}});
  world.state.links[0].pose.orientation.setIdentity();
  const auto put = [&](double x, double y, double z) {
    world.state.links[0].pose.position = {x, y, z - 0.1};
    return visible(drawing_of(world, forward_view()));
  };
  // f = 300 and 320 x 240: at x = 3 the edges are at y = ±1.6 and z = ±1.2.
  EXPECT_EQ(put(3, 0, 0), 1u);
  EXPECT_EQ(put(3, 1.65, 0), 1u);
  EXPECT_EQ(put(3, 1.75, 0), 0u);
  EXPECT_EQ(put(3, -1.75, 0), 0u);
  EXPECT_EQ(put(3, 0, 1.25), 1u);
  EXPECT_EQ(put(3, 0, 1.35), 0u);
  EXPECT_EQ(put(3, 0, -1.35), 0u);
  EXPECT_EQ(put(-3, 0, 0), 0u);
  EXPECT_EQ(drawing_of(world, forward_view()).bodies.size(), 1u) << "it may still throw a shadow";
}

TEST(Drawing, UsesFinerMeshesForLargeBodies) {
  SmallWorld world;
  world.add(scene::Sphere{0.1}, {{50, 0, 0}, math::Quaternion::Identity()});
  const auto far = drawing_of(world, forward_view());
  world.state.links[0].pose.position.x() = 0.5;
  const auto near = drawing_of(world, forward_view());
  EXPECT_LT(far.batches.at(0).mesh.indices, near.batches.at(0).mesh.indices / 10);
}

TEST(Drawing, PutsTogetherACapsuleOfACylinderAndTwoSpheres) {
  SmallWorld world;
  world.add(scene::Capsule{0.1, 0.5}, {{3, 0, 0}, math::Quaternion::Identity()});
  const Drawing drawing = drawing_of(world, forward_view());
  ASSERT_EQ(drawing.bodies.size(), 3u);
  // In the camera's frame y is down: the feet are at the heights of the two balls' lowest points
  // and of the cylinder's lower end.
  EXPECT_NEAR(drawing.bodies[0].position[1], -0.1, 1e-6);
  EXPECT_NEAR(drawing.bodies[1].position[1], 0, 1e-6);
  EXPECT_NEAR(drawing.bodies[2].position[1], -0.3, 1e-6);
}

TEST(Drawing, SharesTheMeshOfAHullAndTakesNewOnes) {
  SmallWorld world;
  const auto pyramid = [](double height) {
    return std::get<scene::Hull>(scene::make_hull(
        std::vector<math::Vector3>{{0, 0, 0}, {0.2, 0, 0}, {0, 0.2, 0}, {0, 0, height}}));
  };
  const scene::Hull low = pyramid(0.1);
  world.add(low, {{3, 0, 0}, math::Quaternion::Identity()});
  world.add(low, {{4, 0, 0}, math::Quaternion::Identity()});
  Draftsman draftsman(make_model(world.scene, world.entities), world.layout);
  Drawing drawing;
  draftsman.draw(world.state, forward_view(), drawing);
  ASSERT_EQ(drawing.batches.size(), 1u);
  EXPECT_EQ(drawing.batches[0].all, 2u);
  EXPECT_EQ(drawing.batches[0].mesh.indices, 3u * 12);
  const std::size_t before = draftsman.meshes().indices.size();
  world.add(pyramid(0.3), {{5, 0, 0}, math::Quaternion::Identity()});
  draftsman.add(world.entities.back(), 2);
  EXPECT_EQ(draftsman.meshes().indices.size(), before + 36);
  draftsman.draw(world.state, forward_view(), drawing);
  EXPECT_EQ(drawing.batches.size(), 2u);
}

TEST(Drawing, MapsEverythingInViewToTheShadowMap) {
  SmallWorld world;
  world.add(scene::Box{{1, 1, 1}}, {{4, 0, -1}, math::Quaternion::Identity()});
  world.add(scene::Sphere{0.2}, {{6, 1, 0}, math::Quaternion::Identity()});
  world.add(scene::Sphere{0.2}, {{-6, 1, 8}, math::Quaternion::Identity()});  // behind the camera
  const View view = forward_view();
  const Drawing drawing = drawing_of(world, view);
  EXPECT_GT(drawing.shadow_texel, 0);
  const Eigen::Map<const Eigen::Matrix4f> light(drawing.light_from_camera.data());
  for (const math::Vector3& point :
       {math::Vector3(3.5, -0.5, -1), {4.5, 0.5, 0}, {6, 1, 0.4}, {6.2, 1, 0.2}}) {
    const math::Vector3 seen = math::inverse(view.camera) * point;
    const Eigen::Vector4f place =
        light * Eigen::Vector4f(static_cast<float>(seen.x()), static_cast<float>(seen.y()),
                                static_cast<float>(seen.z()), 1);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GE(place[axis], 0) << point.transpose();
      EXPECT_LE(place[axis], 1) << point.transpose();
    }
  }
  EXPECT_EQ(drawing.bodies.size(), 3u);
  EXPECT_EQ(visible(drawing), 2u);
}

}  // namespace
}  // namespace ziggurat::render
