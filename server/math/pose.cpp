// SPDX-License-Identifier: MIT
#include "math/pose.h"

#include <Eigen/Eigenvalues>

namespace ziggurat::math {
namespace {

/// Off-diagonal inertia below this share of the diagonal is rounding.
constexpr double rounding = 1e-12;

}  // namespace

Quaternion principal_axes(const Eigen::Matrix3d& inertia) {
  const Eigen::Matrix3d rest = inertia - Eigen::Matrix3d(inertia.diagonal().asDiagonal());
  if (rest.norm() <= rounding * inertia.norm()) return Quaternion::Identity();
  Eigen::Matrix3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia).eigenvectors();
  if (axes.determinant() < 0) axes.col(2) *= -1;
  return Quaternion(axes).normalized();
}

}  // namespace ziggurat::math
