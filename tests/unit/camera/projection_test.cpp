// SPDX-License-Identifier: MIT
#include "camera/projection.h"

#include <gtest/gtest.h>

#include <cmath>

#include "math/random.h"

namespace ziggurat::camera {
namespace {

using math::Vector2;
using math::Vector3;

world::CameraLayout lens() {
  world::CameraLayout camera;
  camera.near = 0.05;
  camera.far = 2;
  camera.focal_length = {800, 600};
  camera.principal_point = {320, 240};
  camera.resolution = {640, 480};
  return camera;
}

TEST(Projection, HasUToTheRightAndVDown) {
  EXPECT_NEAR((project(lens(), {0.1, -0.2, 0.5}) - Vector2(480, 0)).norm(), 0, 1e-12);
  EXPECT_EQ(project(lens(), {0, 0, 1}), Vector2(320, 240));
}

TEST(InView, IncludesTheLimitsOfRangeAndImage) {
  const world::CameraLayout camera = lens();
  for (const double z : {0.05, 0.3, 2.0}) {
    EXPECT_TRUE(in_view(camera, {0, 0, z})) << z;
    EXPECT_TRUE(in_view(camera, {320 / 800.0 * z, -240 / 600.0 * z, z})) << z;
    EXPECT_TRUE(in_view(camera, {-320 / 800.0 * z, 240 / 600.0 * z, z})) << z;
    EXPECT_FALSE(in_view(camera, {320.001 / 800.0 * z, 0, z})) << z;
    EXPECT_FALSE(in_view(camera, {-320.001 / 800.0 * z, 0, z})) << z;
    EXPECT_FALSE(in_view(camera, {0, 240.001 / 600.0 * z, z})) << z;
    EXPECT_FALSE(in_view(camera, {0, -240.001 / 600.0 * z, z})) << z;
  }
  EXPECT_FALSE(in_view(camera, {0, 0, 0.05 - 1e-6}));
  EXPECT_FALSE(in_view(camera, {0, 0, 2 + 1e-6}));
  EXPECT_FALSE(in_view(camera, {0, 0, -0.3}));
}

TEST(InView, RejectsPositionsThatAreNotFiniteOrTooClose) {
  world::CameraLayout camera = lens();
  for (const double odd : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    EXPECT_FALSE(in_view(camera, {0, 0, odd}));
    EXPECT_FALSE(in_view(camera, {odd, 0, 1}));
    EXPECT_FALSE(in_view(camera, {0, odd, 1}));
  }
  camera.near = 1e-300;
  EXPECT_FALSE(in_view(camera, {0, 0, 0}));
  EXPECT_FALSE(in_view(camera, {1, 1, 1e-200}));
}

TEST(InView, UsesTheImageAlsoWithAnOffCentrePrincipalPoint) {
  world::CameraLayout camera = lens();
  camera.principal_point = {100, 400};
  EXPECT_TRUE(in_view(camera, {539.0 / 800, 0, 1}));   // u = 639
  EXPECT_FALSE(in_view(camera, {541.0 / 800, 0, 1}));  // u = 641
  EXPECT_TRUE(in_view(camera, {-99.0 / 800, 0, 1}));
  EXPECT_FALSE(in_view(camera, {-101.0 / 800, 0, 1}));
  EXPECT_TRUE(in_view(camera, {0, 79.0 / 600, 1}));
  EXPECT_FALSE(in_view(camera, {0, 81.0 / 600, 1}));
  EXPECT_TRUE(in_view(camera, {0, -399.0 / 600, 1}));
  EXPECT_FALSE(in_view(camera, {0, -401.0 / 600, 1}));
  // No point on the axis is in the image.
  camera.principal_point = {-10, 240};
  EXPECT_FALSE(in_view(camera, {0, 0, 1}));
  EXPECT_TRUE(in_view(camera, {0.1, 0, 1}));
}

math::Pose random_pose(math::RandomStream& random) {
  const math::Quaternion turn(random.gaussian(0, 1), random.gaussian(0, 1), random.gaussian(0, 1),
                              random.gaussian(0, 1));
  return {Vector3(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(0, 3)),
          turn.normalized()};
}

TEST(Frustum, HasItsCornersAtTheCornersOfTheImage) {
  world::CameraLayout camera = lens();
  camera.principal_point = {200, 300};
  math::RandomStream random(1, "frustum");
  const math::Pose pose = random_pose(random);
  const auto corners = frustum(camera, pose);
  const Vector2 image[4] = {{0, 0}, {640, 0}, {640, 480}, {0, 480}};
  for (std::size_t i = 0; i < 8; ++i) {
    const Vector3 point = math::inverse(pose) * corners[i];
    EXPECT_NEAR(point.z(), i < 4 ? camera.near : camera.far, 1e-12);
    EXPECT_NEAR((project(camera, point) - image[i % 4]).norm(), 0, 1e-9);
  }
}

TEST(Frustum, HasABoundingBoxOfAllPointsInView) {
  math::RandomStream random(2, "frustum");
  int seen = 0;
  for (int view = 0; view < 200; ++view) {
    world::CameraLayout camera = lens();
    camera.near = random.uniform(1e-3, 1);
    camera.far = camera.near + random.uniform(0, 1);
    camera.focal_length = {random.uniform(50, 900), random.uniform(50, 900)};
    camera.principal_point = {random.uniform(-100, 700), random.uniform(-100, 600)};
    const math::Pose pose = random_pose(random);
    const Bounds box = bounds(frustum(camera, pose));
    const Vector3 size = box.high - box.low;
    for (int i = 0; i < 200; ++i) {
      // Some points are beside the box.
      Vector3 point;
      for (int axis = 0; axis < 3; ++axis) {
        point[axis] = box.low[axis] + random.uniform(-0.2, 1.2) * size[axis];
      }
      if (!in_view(camera, math::inverse(pose) * point)) continue;
      ++seen;
      EXPECT_TRUE((point.array() >= box.low.array()).all());
      EXPECT_TRUE((point.array() <= box.high.array()).all());
    }
  }
  EXPECT_GT(seen, 1000);
}

}  // namespace
}  // namespace ziggurat::camera
