// Steps of the softened problem. With given bounds of friction it is convex, and Newton's method
// with an exact line search always solves it; with bounds that follow the normal impulses it is what
// is wanted, and Newton's method solves it from nearby.

#include <algorithm>
#include <cmath>

#include "dynamics/newton.h"

namespace ziggurat::dynamics {
namespace {

/// out += M x, with the joints' damping.
void add_mass_times(const Problem& problem, const std::vector<double>& x,
                    std::vector<double>& out) {
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    const Tree& tree = *problem.trees[i];
    const int n = tree.dofs, first = problem.offset[i];
    for (int r = 0; r < n; ++r) {
      double sum = problem.length * tree.damping[r] * x[first + r];
      for (int c = 0; c < n; ++c) sum += tree.mass[r * n + c] * x[first + c];
      out[first + r] += sum;
    }
  }
}

double product(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

void add_side(const Problem& problem, int place, int first, int rows, const double* impulse,
              std::vector<double>& out) {
  if (place < 0) return;
  const double* columns = problem.jacobian.data() + first;
  double* to = out.data() + problem.offset[place];
  for (int k = 0; k < problem.trees[place]->dofs; ++k) {
    for (int r = 0; r < rows; ++r) to[k] += columns[k * rows + r] * impulse[r];
  }
}

}  // namespace

/// The slope of the softened energy along the direction vanishes at the best step. It only grows
/// with the step; regula falsi with bisection finds where.
double Solver::line_search(Problem& problem, const std::vector<double>& direction) {
  std::vector<double>& gradient = gradient_;
  gradient.assign(problem.momentum.size(), 0);
  add_mass_times(problem, problem.velocity, gradient);
  for (std::size_t i = 0; i < gradient.size(); ++i) gradient[i] -= problem.momentum[i];
  const double linear = product(gradient, direction);
  gradient.assign(problem.momentum.size(), 0);
  add_mass_times(problem, direction, gradient);
  const double quadratic = product(gradient, direction);
  const std::size_t count = problem.blocks.size();
  const auto slope = [&](double step) {
    double sum = linear + step * quadratic;
    for (std::size_t i = 0; i < count; ++i) {
      const double* now = speeds_.data() + i * Block::most_rows;
      const double* change = changes_.data() + i * Block::most_rows;
      double u[Block::most_rows], impulse[Block::most_rows];
      for (int r = 0; r < problem.blocks[i].rows; ++r) u[r] = now[r] + step * change[r];
      soften(problem.blocks[i], u, options.softness, false, impulse, nullptr);
      for (int r = 0; r < problem.blocks[i].rows; ++r) sum -= change[r] * impulse[r];
    }
    return sum;
  };
  const double at_start = slope(0);
  if (at_start >= 0) return 0;
  const double enough = 1e-3 * -at_start;
  double low = 0, high = 1, at_low = at_start, at_high = slope(1);
  if (at_high <= enough) return 1;
  for (int i = 0; i < 30; ++i) {
    double middle = low - at_low * (high - low) / (at_high - at_low);
    if (i % 3 == 2) middle = (low + high) / 2;
    const double value = slope(middle);
    if (std::abs(value) <= enough) return middle;
    (value < 0 ? low : high) = middle;
    (value < 0 ? at_low : at_high) = value;
  }
  return low > 0 ? low : high;
}

/// One Newton step of the softened problem.
/// @return  false where it can't get better
bool Solver::descend(Problem& problem, bool coupled, double& largest) {
  const std::size_t count = problem.blocks.size();
  start_matrix(problem);
  gradient_.assign(problem.momentum.size(), 0);
  add_mass_times(problem, problem.velocity, gradient_);
  direction_ = problem.momentum;
  for (std::size_t k = 0; k < gradient_.size(); ++k) direction_[k] -= gradient_[k];
  for (std::size_t k = 0; k < count; ++k) {
    Block& block = problem.blocks[k];
    double* u = speeds_.data() + k * Block::most_rows;
    problem.speeds(block, u);
    soften(block, u, options.softness, coupled, block.impulse.data(), &linear_[k]);
    add_side(problem, block.a, block.ja, block.rows, block.impulse.data(), direction_);
    add_side(problem, block.b, block.jb, block.rows, block.impulse.data(), direction_);
    add_slope(problem, block, linear_[k]);
  }
  if (!matrix_.factor()) return false;
  matrix_.solve(direction_.data());
  std::swap(problem.velocity, direction_);
  largest = 0;
  for (std::size_t k = 0; k < count; ++k) {
    double* change = changes_.data() + k * Block::most_rows;
    problem.speeds(problem.blocks[k], change);
    for (int r = 0; r < problem.blocks[k].rows; ++r) {
      largest = std::max(largest, std::abs(change[r]));
    }
  }
  std::swap(problem.velocity, direction_);
  const double step = coupled ? 1 : line_search(problem, direction_);
  for (std::size_t k = 0; k < direction_.size(); ++k) problem.velocity[k] += step * direction_[k];
  for (Block& block : problem.blocks) {
    double u[Block::most_rows];
    problem.speeds(block, u);
    soften(block, u, options.softness, coupled, block.impulse.data(), nullptr);
  }
  return step > 0;
}

/// Solves the softened problem about the present anchors.
/// @param coupled  whether friction's bounds follow the normal impulses
/// @param enough   change of a speed at which it is solved [m/s] or [rad/s]
/// @return         whether it was solved
bool Solver::relax(Problem& problem, Outcome& outcome, bool coupled, double enough) {
  const std::size_t count = problem.blocks.size();
  speeds_.resize(count * Block::most_rows);
  changes_.resize(count * Block::most_rows);
  const int most = coupled ? options.most_coupled : options.most_descents;
  for (int i = 0; i < most; ++i) {
    double largest = 0;
    ++outcome.descents;
    if (!descend(problem, coupled, largest)) return false;
    if (largest <= enough) return true;
  }
  return false;
}

}  // namespace ziggurat::dynamics
