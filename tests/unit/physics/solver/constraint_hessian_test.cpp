// SPDX-License-Identifier: MIT
// Hessians of contacts in an island's matrix, against the product of dense matrices.

#include "physics/solver/constraint_hessian.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <vector>

#include "../stepping/trees.h"

namespace ziggurat::dynamics::testing {
namespace {

/// An arm on the ground with six revolute joints about different axes.
Tree arm() {
  std::vector<Link> links{ground()};
  for (int i = 0; i < 6; ++i) {
    links.push_back(hung(box_link({0.1, 0.1, 0.2}, 1), i, JointType::revolute, Vector3::Unit(i % 3),
                         {0.01, 0.02, 0.1}, {0, 0, -0.1}));
  }
  return Tree(links, math::Pose{});
}

/// J of a block's row and all dofs of the problem, from the speeds that unit velocities give.
Eigen::MatrixXd jacobian_of(Problem& problem, const Constraint& block) {
  Eigen::MatrixXd jacobian(block.rows, static_cast<Eigen::Index>(problem.velocity.size()));
  for (std::size_t k = 0; k < problem.velocity.size(); ++k) {
    problem.velocity.assign(problem.velocity.size(), 0);
    problem.velocity[k] = 1;
    double u[Constraint::most_rows];
    problem.constraint_velocity(block, u);
    for (int r = 0; r < block.rows; ++r) jacobian(r, static_cast<Eigen::Index>(k)) = u[r];
  }
  return jacobian;
}

/// Checks a contact with rolling friction between the last links of two trees.
void expect_product(Tree first, Tree second) {
  std::vector<Tree> trees{std::move(first), std::move(second)};
  Workspace work;
  Problem problem;
  problem.time_step = 0.01;
  std::vector<int> sizes;
  for (Tree& each : trees) {
    forward_kinematics(each);
    velocity_kinematics(each);
    problem.add(each, work, false);
    sizes.push_back(each.dofs);
  }
  ContactPoint contact;
  contact.a = {0, static_cast<int>(trees[0].links.size()) - 1};
  contact.b = {1, static_cast<int>(trees[1].links.size()) - 1};
  contact.point = {0.3, 0.2, 0.1};
  contact.normal = Vector3(1, 2, 3).normalized();
  contact.friction = 0.5;
  contact.rolling_friction = 0.01;
  contact.spinning_friction = 0.02;
  problem.add(contact, 0, 1, 0);
  ASSERT_EQ(problem.constraints.size(), 1U);
  Constraint& block = problem.constraints[0];
  ASSERT_EQ(block.rows, 6);
  LinearisedLaw linear;
  const double pressed[Constraint::most_rows] = {-1, 1e-4, 2e-4, 3e-5, 1e-5, 2e-5};
  linearise(block, pressed, linear);
  ASSERT_FALSE(linear.is_zero);

  BlockMatrix matrix;
  matrix.shape(sizes, problem.couplings);
  matrix.clear();
  std::vector<double> memory;
  add_constraint_hessian(problem, block, linear, memory, matrix);

  const Eigen::MatrixXd jacobian = jacobian_of(problem, block);
  const Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>> slope(linear.hessian.data());
  ASSERT_GT(slope.bottomRightCorner(3, 3).norm(), 0) << "rolling has a part";
  const Eigen::MatrixXd product = jacobian.transpose() * slope * jacobian;
  const double scale = product.cwiseAbs().maxCoeff();
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      for (int r = 0; r < sizes[i]; ++r) {
        for (int c = 0; c < sizes[j]; ++c) {
          EXPECT_NEAR(matrix.block(i, j)[r * sizes[j] + c],
                      product(problem.offset[i] + r, problem.offset[j] + c), 1e-12 * scale)
              << "block " << i << ", " << j << ", entry " << r << ", " << c;
        }
      }
    }
  }
}

TEST(ConstraintHessian, IsTheProductForFreeBodies) {
  expect_product(box({0.1, 0.2, 0.3}, 2, math::Pose{}), box({0.1, 0.1, 0.1}, 1, math::Pose{}));
}

TEST(ConstraintHessian, IsTheProductForAnArmOfSixJointsOnTheGround) {
  expect_product(arm(), box({0.1, 0.1, 0.1}, 1, math::Pose{}));
  expect_product(box({0.1, 0.1, 0.1}, 1, math::Pose{}), arm());
}

}  // namespace
}  // namespace ziggurat::dynamics::testing
