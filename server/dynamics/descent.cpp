// The robust way: the softened law about the impulses of before is a convex problem, which Newton's
// method with an exact line search always solves; then its impulses become the anchor, and the
// bounds of friction follow the normal impulses (the method of multipliers, R. T. Rockafellar,
// Math. Oper. Res. 1, 1976, for each bound of friction).

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
      soften(problem.blocks[i], u, options.softness, impulse, nullptr);
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

/// Steps of the softened problem, anchored anew each time it is solved well enough.
void Solver::descend(Problem& problem, Outcome& outcome) {
  const std::size_t count = problem.blocks.size();
  speeds_.resize(count * Block::most_rows);
  changes_.resize(count * Block::most_rows);
  for (Block& block : problem.blocks) anchor(block);
  double scale = 0;
  for (int i = 0; i < options.most_descents; ++i) {
    direction_ = problem.momentum;
    start_matrix(problem);
    gradient_.assign(problem.momentum.size(), 0);
    add_mass_times(problem, problem.velocity, gradient_);
    for (std::size_t k = 0; k < gradient_.size(); ++k) direction_[k] -= gradient_[k];
    for (std::size_t k = 0; k < count; ++k) {
      Block& block = problem.blocks[k];
      double* u = speeds_.data() + k * Block::most_rows;
      problem.speeds(block, u);
      soften(block, u, options.softness, block.impulse.data(), &linear_[k]);
      add_side(problem, block.a, block.ja, block.rows, block.impulse.data(), direction_);
      add_side(problem, block.b, block.jb, block.rows, block.impulse.data(), direction_);
      add_slope(problem, block, linear_[k]);
    }
    if (!matrix_.factor()) break;
    matrix_.solve(direction_.data());
    std::swap(problem.velocity, direction_);
    double largest = 0;
    for (std::size_t k = 0; k < count; ++k) {
      double* change = changes_.data() + k * Block::most_rows;
      problem.speeds(problem.blocks[k], change);
      for (int r = 0; r < problem.blocks[k].rows; ++r) {
        largest = std::max(largest, std::abs(change[r]));
      }
    }
    std::swap(problem.velocity, direction_);
    const double step = line_search(problem, direction_);
    for (std::size_t k = 0; k < direction_.size(); ++k) {
      problem.velocity[k] += step * direction_[k];
    }
    for (Block& block : problem.blocks) {
      double u[Block::most_rows];
      problem.speeds(block, u);
      soften(block, u, options.softness, block.impulse.data(), nullptr);
    }
    ++outcome.descents;
    outcome.miss = worst_miss(problem, scale);
    // Solved as well as its anchor is right: take a better one.
    const bool solved = step == 1 && largest <= std::max(tolerance(scale), 0.3 * outcome.miss);
    if (solved && outcome.miss <= tolerance(scale)) {
      outcome.converged = true;
      return;
    }
    if (solved || step == 0) {
      for (Block& block : problem.blocks) anchor(block);
    }
  }
  outcome.converged = false;
}

}  // namespace ziggurat::dynamics
