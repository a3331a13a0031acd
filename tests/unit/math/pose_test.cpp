// SPDX-License-Identifier: MIT
#include "math/pose.h"

#include <gtest/gtest.h>

namespace ziggurat::math {
namespace {

const Pose a_b{{1, 2, 3}, Quaternion(Eigen::AngleAxisd(0.7, Vector3(1, 2, -1).normalized()))};
const Pose b_c{{-0.5, 0.25, 4}, Quaternion(Eigen::AngleAxisd(-1.9, Vector3(0, 1, 3).normalized()))};

TEST(Pose, CompositionTransformsLikeItsParts) {
  const Vector3 point(0.3, -0.2, 0.9);
  EXPECT_LT((((a_b * b_c) * point) - (a_b * (b_c * point))).norm(), 1e-14);
}

TEST(Pose, InverseUndoes) {
  const Vector3 point(0.3, -0.2, 0.9);
  EXPECT_LT((inverse(a_b) * (a_b * point) - point).norm(), 1e-14);
}

TEST(Pose, QuarterTurnAboutZTakesXToY) {
  const Pose turn{{0, 0, 0}, Quaternion(Eigen::AngleAxisd(EIGEN_PI / 2, Vector3::UnitZ()))};
  EXPECT_LT((turn * Vector3(1, 0, 0) - Vector3(0, 1, 0)).norm(), 1e-15);
}

}  // namespace
}  // namespace ziggurat::math
