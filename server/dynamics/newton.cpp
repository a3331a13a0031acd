#include "dynamics/newton.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ziggurat::dynamics {
namespace {

/// sloped := slope times the columns, row by row.
/// @param columns  R values per dof
template <int R>
void apply_slope(const double* slope, const double* columns, int dofs, double* sloped) {
  for (int k = 0; k < dofs; ++k, columns += R) {
    for (int r = 0; r < R; ++r) {
      double sum = 0;
      for (int c = 0; c < R; ++c) sum += slope[r * R + c] * columns[c];
      sloped[r * dofs + k] = sum;
    }
  }
}

/// out += columns^T sloped, n x m.
template <int R>
void add_product(const double* columns, int n, const double* sloped, int m, double* out) {
  for (int i = 0; i < n; ++i, columns += R, out += m) {
    for (int j = 0; j < m; ++j) {
      double sum = out[j];
      for (int r = 0; r < R; ++r) sum += columns[r] * sloped[r * m + j];
      out[j] = sum;
    }
  }
}

/// The same for one body each: sizes that the compiler knows.
template <int R>
void add_body_product(const double* columns, const double* sloped, double* out) {
  for (int i = 0; i < 6; ++i, columns += R, out += 6) {
    double row[6];
    for (int j = 0; j < 6; ++j) row[j] = out[j];
    for (int r = 0; r < R; ++r) {
      for (int j = 0; j < 6; ++j) row[j] += columns[r] * sloped[r * 6 + j];
    }
    for (int j = 0; j < 6; ++j) out[j] = row[j];
  }
}

/// Adds J^T slope J of a block of R rows to the matrix.
template <int R>
void add_slope_of(const Problem& problem, const Block& block, const double* slope,
                  std::vector<double>& sloped, BlockMatrix& matrix) {
  const int sides[] = {block.a, block.b}, first[] = {block.ja, block.jb};
  for (int s = 0; s < 2; ++s) {
    if (sides[s] < 0) continue;
    const int m = problem.trees[sides[s]]->dofs;
    sloped.resize(static_cast<std::size_t>(m) * R);
    apply_slope<R>(slope, problem.jacobian.data() + first[s], m, sloped.data());
    for (int t = 0; t < 2; ++t) {
      if (sides[t] < 0) continue;
      const double* columns = problem.jacobian.data() + first[t];
      const int n = problem.trees[sides[t]]->dofs;
      double* out = matrix.block(sides[t], sides[s]);
      if (n == 6 && m == 6) {
        add_body_product<R>(columns, sloped.data(), out);
      } else {
        add_product<R>(columns, n, sloped.data(), m, out);
      }
    }
  }
}

}  // namespace

/// Adds J^T slope J to the matrix.
void Solver::add_slope(const Problem& problem, const Block& block, const Linear& linear) {
  if (linear.zero) return;
  const double* slope = linear.slope.data();
  if (block.rows == 3) return add_slope_of<3>(problem, block, slope, sloped_, matrix_);
  if (block.rows == 1) return add_slope_of<1>(problem, block, slope, sloped_, matrix_);
  add_slope_of<6>(problem, block, slope, sloped_, matrix_);
}

/// Adds J^T constant to the right-hand side, which is in v.
void Solver::add_constant(Problem& problem, const Block& block, const Linear& linear) {
  if (linear.zero) return;
  const int sides[] = {block.a, block.b}, first[] = {block.ja, block.jb};
  for (int s = 0; s < 2; ++s) {
    if (sides[s] < 0) continue;
    const int rows = block.rows;
    const double* columns = problem.jacobian.data() + first[s];
    double* right = problem.velocity.data() + problem.offset[sides[s]];
    for (int k = 0; k < problem.trees[sides[s]]->dofs; ++k) {
      for (int r = 0; r < rows; ++r) right[k] += columns[k * rows + r] * linear.constant[r];
    }
  }
}

/// The mass matrices.
void Solver::start_matrix(Problem& problem) {
  matrix_.clear();
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    const Tree& tree = *problem.trees[i];
    double* block = matrix_.block(static_cast<int>(i), static_cast<int>(i));
    std::copy(tree.mass.begin(), tree.mass.end(), block);
    for (int k = 0; k < tree.dofs; ++k) {
      block[k * tree.dofs + k] += problem.length * tree.damping[k];
    }
  }
}

/// One step of Newton's method.
/// @return  false if the matrix has no factors; then nothing has changed
bool Solver::step(Problem& problem) {
  for (std::size_t i = 0; i < problem.blocks.size(); ++i) {
    double u[Block::most_rows];
    problem.speeds(problem.blocks[i], u);
    linearise(problem.blocks[i], u, linear_[i]);
  }
  kept_velocity_ = problem.velocity;
  start_matrix(problem);
  problem.velocity = problem.momentum;
  for (std::size_t i = 0; i < problem.blocks.size(); ++i) {
    add_slope(problem, problem.blocks[i], linear_[i]);
    add_constant(problem, problem.blocks[i], linear_[i]);
  }
  if (!matrix_.factor()) {
    problem.velocity = kept_velocity_;
    return false;
  }
  matrix_.solve(problem.velocity.data());
  for (std::size_t i = 0; i < problem.blocks.size(); ++i) {
    Block& block = problem.blocks[i];
    const Linear& linear = linear_[i];
    if (linear.zero) {
      block.impulse.fill(0);
      continue;
    }
    double u[Block::most_rows];
    problem.speeds(block, u);
    for (int r = 0; r < block.rows; ++r) {
      double sum = linear.constant[r];
      for (int c = 0; c < block.rows; ++c) sum -= linear.slope[r * block.rows + c] * u[c];
      block.impulse[r] = sum;
    }
  }
  return true;
}

/// @param scale  out: the largest speed, or change of speed by an impulse
double Solver::worst_miss(const Problem& problem, double& scale) const {
  double worst = 0;
  scale = 0;
  for (const Block& block : problem.blocks) {
    double u[Block::most_rows];
    problem.speeds(block, u);
    worst = std::max(worst, miss(block, u));
    for (int r = 0; r < block.rows; ++r) {
      scale = std::max({scale, std::abs(u[r]), std::abs(block.impulse[r]) * block.mobility[r]});
    }
  }
  return worst;
}

void Solver::Snapshot::take(const Problem& problem) {
  velocity = problem.velocity;
  impulses.clear();
  for (const Block& block : problem.blocks) impulses.push_back(block.impulse);
}

void Solver::Snapshot::give_back(Problem& problem) const {
  problem.velocity = velocity;
  for (std::size_t i = 0; i < impulses.size(); ++i) problem.blocks[i].impulse = impulses[i];
}

/// Newton's method from the present state.
/// @return  whether it converged; then the problem holds the solution
bool Solver::iterate(Problem& problem, Outcome& outcome, int most) {
  double scale = 0;
  for (int i = 0; i < most; ++i) {
    if (!step(problem)) return false;
    ++outcome.iterations;
    outcome.miss = worst_miss(problem, scale);
    if (outcome.miss <= tolerance(scale)) return true;
  }
  return false;
}

/// Shapes the matrix and keeps the state.
void Solver::start(Problem& problem) {
  sizes_.clear();
  for (const Tree* tree : problem.trees) sizes_.push_back(tree->dofs);
  matrix_.shape(sizes_, problem.couplings);
  linear_.resize(problem.blocks.size());
  start_.take(problem);
}

/// Whether the velocities and impulses of the last substep still solve the problem.
bool Solver::still_solved(const Problem& problem, Outcome& outcome) {
  double scale = 0;
  outcome.miss = worst_miss(problem, scale);
  const double enough = options.absolute_tolerance + options.still_tolerance * scale;
  return outcome.miss <= enough && imbalance(problem, residual_) <= enough;
}

Outcome Solver::solve(Problem& problem) {
  Outcome outcome;
  if (still_solved(problem, outcome)) return outcome;
  start(problem);
  if (matrix_.work() > options.most_work) {
    sweep_until_converged(problem, outcome, options.most_sweeps);
    return outcome;
  }
  if (matrix_.work() <= options.newton_work) {
    if (iterate(problem, outcome, options.most_iterations)) return outcome;
    start_.give_back(problem);
  }
  if (proximal(problem, outcome, options.most_descents)) return outcome;
  start_.give_back(problem);
  interior_points(problem, outcome);
  if (proximal(problem, outcome, options.most_descents)) return outcome;
  sweep_until_converged(problem, outcome, options.last_sweeps);
  return outcome;
}

void Solver::solve_displacement(Problem& problem) {
  Outcome outcome;
  start(problem);
  if (matrix_.work() <= options.newton_work) {
    if (iterate(problem, outcome, options.most_iterations)) return;
    start_.give_back(problem);
  }
  sweep_until_converged(problem, outcome, options.displacement_sweeps);
}

}  // namespace ziggurat::dynamics
