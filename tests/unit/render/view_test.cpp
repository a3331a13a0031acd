// SPDX-License-Identifier: MIT
#include "render/view.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ziggurat::render {
namespace {

using math::Vector3;

TEST(LookAt, HasItsTargetAheadAndTheWorldUpright) {
  const math::Pose camera = look_at({1, 2, 3}, {4, 6, 3});
  EXPECT_TRUE((camera.orientation * Vector3::UnitZ()).isApprox(Vector3(0.6, 0.8, 0)));
  EXPECT_TRUE((camera.orientation * Vector3::UnitX()).isApprox(Vector3(0.8, -0.6, 0)));
  EXPECT_TRUE((camera.orientation * Vector3::UnitY()).isApprox(Vector3(0, 0, -1)));
}

TEST(LookAt, HasYUpSeenFromAbove) {
  const math::Pose camera = look_at({1, 2, 3}, {1, 2, 0});
  EXPECT_TRUE((camera.orientation * Vector3::UnitX()).isApprox(Vector3(1, 0, 0)));
  EXPECT_TRUE((camera.orientation * Vector3::UnitY()).isApprox(Vector3(0, -1, 0)));
}

TEST(LookAt, LooksAlongXIfEyeAndTargetAreEqual) {
  const math::Pose camera = look_at({1, 2, 3}, {1, 2, 3});
  EXPECT_TRUE((camera.orientation * Vector3::UnitZ()).isApprox(Vector3(1, 0, 0)));
}

TEST(SymmetricView, HasItsFieldOfViewFromEdgeToEdge) {
  const View view = symmetric_view({}, M_PI / 2, 640, 480);
  EXPECT_NEAR(view.focal_length.x(), 320, 1e-9);  // tan 45 degrees = 320 / f
  EXPECT_EQ(view.focal_length.x(), view.focal_length.y());
  EXPECT_EQ(view.principal_point, math::Vector2(320, 240));
}

}  // namespace
}  // namespace ziggurat::render
