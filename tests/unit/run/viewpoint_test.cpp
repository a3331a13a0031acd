// SPDX-License-Identifier: MIT
#include "run/viewpoint.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ziggurat::run {
namespace {

using math::Pose;
using math::Quaternion;
using math::Vector3;

math::Vector2 project(const render::View& view, const Vector3& point) {
  const Vector3 seen = math::inverse(view.camera) * point;
  EXPECT_GT(seen.z(), 0);
  return view.focal_length.cwiseProduct(seen.head<2>() / seen.z()) + view.principal_point;
}

TEST(ChooseView, FillsThePictureWithTheWholeArena) {
  const Extent extent{{-2, -1, 0}, {3, 4, 0.5}};
  for (const unsigned height : {200u, 800u, 3000u}) {
    ViewOptions options;
    options.width = 800;
    options.height = height;
    const auto view = choose_view(options, extent);
    double left = 1, right = 0, top = 1, bottom = 0;  // shares of the picture
    for (unsigned i = 0; i < 8; ++i) {
      const auto at =
          project(view, {(i & 1u) ? 3.0 : -2.0, (i & 2u) ? 4.0 : -1.0, (i & 4u) ? 0.5 : 0.0});
      left = std::min(left, at.x() / 800);
      right = std::max(right, at.x() / 800);
      top = std::min(top, at.y() / height);
      bottom = std::max(bottom, at.y() / height);
    }
    EXPECT_GT(left, 0.02);
    EXPECT_LT(right, 0.98);
    EXPECT_GT(top, 0.02);
    EXPECT_LT(bottom, 0.98);
    EXPECT_NEAR(std::max(right - left, bottom - top), 0.95, 1e-6) << height;
  }
}

TEST(ChooseView, TakesTheEyeAndWhatItLooksAt) {
  ViewOptions options;
  options.eye = {1, -2, 3};
  options.look_at = {0, 0, 1};
  const auto view = choose_view(options, {{-1, -1, 0}, {1, 1, 1}});
  EXPECT_TRUE(view.camera.position.isApprox(Vector3(1, -2, 3)));
  EXPECT_TRUE(project(view, {0, 0, 1}).isApprox(math::Vector2(640, 360)));
  options.look_at.reset();
  EXPECT_TRUE(project(choose_view(options, {{-1, -1, 0}, {1, 1, 1}}), {0, 0, 0.5})
                  .isApprox(math::Vector2(640, 360)));
}

TEST(ExtentOf, EndsWhereTheHighestThingEnds) {
  scene::Scene scene;
  scene.arena.size = {4, 4, 4};
  scene.arena.center = {1, 0, 1};
  scene::Entity entity;
  entity.links.emplace_back();
  std::vector<scene::Entity> entities{entity};
  world::State state;
  state.links.resize(1);
  const auto top = [&](const scene::Geometry& geometry, const Quaternion& orientation) {
    entities[0].links[0].geometry = geometry;
    state.links[0].pose = {{0, 0, 0.5}, orientation};
    return extent_of(scene, entities, state).high.z();
  };
  const Quaternion up = Quaternion::Identity(), down(0, 1, 0, 0);
  const Quaternion lying(Eigen::AngleAxisd(M_PI / 2, Vector3::UnitX()));
  EXPECT_EQ(top(scene::Box{{1, 1, 0.4}}, up), 3) << "without floor it is the arena";
  scene.physics.floor.emplace();
  EXPECT_NEAR(top(scene::Box{{1, 1, 0.4}}, up), 0.9, 1e-12);
  EXPECT_NEAR(top(scene::Box{{1, 1, 0.4}}, down), 0.5, 1e-12);
  EXPECT_NEAR(top(scene::Box{{1, 0.6, 0.4}}, lying), 0.8, 1e-12);
  EXPECT_NEAR(top(scene::Cylinder{0.3, 0.4}, up), 0.9, 1e-12);
  EXPECT_NEAR(top(scene::Cylinder{0.3, 0.4}, lying), 0.8, 1e-12);
  EXPECT_NEAR(top(scene::Sphere{0.3}, up), 1.1, 1e-12);
  EXPECT_NEAR(top(scene::Sphere{0.3}, lying), 0.8, 1e-12);
  EXPECT_EQ(top(scene::Box{{1, 1, 9}}, up), 3) << "nor higher than the arena";
  EXPECT_EQ(extent_of(scene, entities, state).low, Vector3(-1, -2, 0));
}

}  // namespace
}  // namespace ziggurat::run
