// SPDX-License-Identifier: MIT
// Systems of blocks against Eigen.

#include "physics/solver/block_matrix.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace ziggurat::dynamics {
namespace {

// Sliding friction makes matrices unsymmetric, with negative pivots.
TEST(BlockMatrix, SolvesUnsymmetricSystemsWithNegativePivots) {
  const std::vector<int> sizes{6, 3, 6, 8, 1};
  const std::vector<std::pair<int, int>> couplings{{0, 1}, {1, 2}, {0, 3}, {2, 3}, {3, 4}};
  BlockMatrix matrix;
  matrix.shape(sizes, couplings);
  matrix.clear();
  ASSERT_EQ(matrix.rows(), 24);
  std::mt19937 random(7);
  const auto draw = [&] { return static_cast<double>(random() % 2001) / 1000 - 1; };
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(24, 24);
  const auto fill = [&](int i, int j) {
    double* constraint = matrix.block(i, j);
    for (int r = 0; r < sizes[i]; ++r) {
      for (int c = 0; c < sizes[j]; ++c) {
        double value = draw();
        if (i == j && r == c) value += r % 2 ? -8 : 8;
        constraint[r * sizes[j] + c] = value;
        dense(matrix.offset(i) + r, matrix.offset(j) + c) = value;
      }
    }
  };
  for (int i = 0; i < 5; ++i) fill(i, i);
  for (const auto& [i, j] : couplings) fill(i, j), fill(j, i);
  Eigen::VectorXd x(24);
  for (int i = 0; i < 24; ++i) x[i] = draw();
  Eigen::VectorXd b = dense * x;
  ASSERT_TRUE(matrix.factor());
  matrix.solve(b.data());
  EXPECT_LT((b - x).norm(), 1e-11);
}

// A heap of mechanisms whose factors would take 18 GB is solved by passes: it takes no memory to
// find that out.
TEST(BlockMatrix, TellsItsWorkBeforeItTakesMemory) {
  const std::vector<int> sizes(300, 160);
  std::vector<std::pair<int, int>> couplings;
  for (int i = 0; i < 300; ++i) {
    for (int j = 0; j < i; ++j) couplings.push_back({j, i});
  }
  BlockMatrix matrix;
  ASSERT_NO_THROW(matrix.shape(sizes, couplings));
  EXPECT_NEAR(matrix.work() / (std::pow(300. * 160, 3) / 3), 1, 0.01);
}

TEST(BlockMatrix, TellsWhenAPivotVanishes) {
  BlockMatrix matrix;
  const std::vector<int> sizes{2};
  matrix.shape(sizes, {});
  matrix.clear();
  EXPECT_FALSE(matrix.factor());
}

}  // namespace
}  // namespace ziggurat::dynamics
