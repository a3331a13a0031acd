// Newton's method on the softened problem: impulses give way about an anchor, the impulses known so
// far. From the impulses of the last substep a heap at rest takes one step of it.

#include <algorithm>
#include <cmath>

#include "dynamics/newton.h"

namespace ziggurat::dynamics {

/// out += J^T impulse of a block.
void add_impulse(const Problem& problem, const Block& block, const double* impulse,
                 std::vector<double>& out) {
  const int sides[] = {block.a, block.b}, first[] = {block.ja, block.jb};
  for (int s = 0; s < 2; ++s) {
    if (sides[s] < 0) continue;
    const double* column = problem.jacobian.data() + first[s];
    double* to = out.data() + problem.offset[sides[s]];
    const int dofs = problem.trees[sides[s]]->dofs;
    if (block.rows == 3) {
      for (int k = 0; k < dofs; ++k, column += 3) {
        to[k] += column[0] * impulse[0] + column[1] * impulse[1] + column[2] * impulse[2];
      }
      continue;
    }
    for (int k = 0; k < dofs; ++k, column += block.rows) {
      double sum = 0;
      for (int r = 0; r < block.rows; ++r) sum += column[r] * impulse[r];
      to[k] += sum;
    }
  }
}

/// out := p + J^T g - M v, with the joints' damping in M.
/// @return  the largest change of a coordinate's speed that is missing, about [m/s] or [rad/s]
double imbalance(const Problem& problem, std::vector<double>& out) {
  out = problem.momentum;
  for (const Block& block : problem.blocks) {
    add_impulse(problem, block, block.impulse.data(), out);
  }
  double worst = 0;
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    const Tree& tree = *problem.trees[i];
    const int n = tree.dofs;
    const double* v = problem.velocity.data() + problem.offset[i];
    double* to = out.data() + problem.offset[i];
    for (int r = 0; r < n; ++r) {
      double sum = problem.length * tree.damping[r] * v[r];
      for (int c = 0; c < n; ++c) sum += tree.mass[r * n + c] * v[c];
      to[r] -= sum;
      worst = std::max(worst, std::abs(to[r]) / tree.mass[r * n + r]);
    }
  }
  return worst;
}

/// One step about the anchors.
/// @return  false if the matrix has no factors
bool Solver::proximal_step(Problem& problem) {
  start_matrix(problem);
  for (std::size_t k = 0; k < problem.blocks.size(); ++k) {
    Block& block = problem.blocks[k];
    double u[Block::most_rows];
    problem.speeds(block, u);
    soften(block, u, options.softness, block.impulse.data(), &linear_[k]);
    add_slope(problem, block, linear_[k]);
  }
  imbalance(problem, direction_);
  if (!matrix_.factor()) return false;
  matrix_.solve(direction_.data());
  for (std::size_t k = 0; k < direction_.size(); ++k) problem.velocity[k] += direction_[k];
  for (Block& block : problem.blocks) {
    double u[Block::most_rows];
    problem.speeds(block, u);
    soften(block, u, options.softness, block.impulse.data(), nullptr);
  }
  return true;
}

/// Steps as long as they lead nearer to the law.
/// @return  whether the miss became small; otherwise the problem holds the best state met
bool Solver::proximal(Problem& problem, Outcome& outcome, int most) {
  double scale = 0;
  double before = std::max(worst_miss(problem, scale), imbalance(problem, residual_));
  snapshot_.take(problem);
  double best = before;
  for (Block& block : problem.blocks) block.anchor = block.impulse;
  bool enough = false;
  for (int i = 0; i < most; ++i) {
    ++outcome.descents;
    if (!proximal_step(problem)) break;
    const double unbalanced = imbalance(problem, residual_);
    const double law = worst_miss(problem, scale);
    const double now = std::max(law, unbalanced);
    if (!(now < HUGE_VAL)) break;
    if (now < best) {
      best = now;
      snapshot_.take(problem);
    }
    if (now <= tolerance(scale)) return outcome.miss = now, true;
    enough = best <= options.absolute_tolerance + options.soft_tolerance * scale;
    if (i > 0 && now > 0.3 * before) break;
    before = now;
    if (unbalanced <= 0.1 * law) {
      for (Block& block : problem.blocks) block.anchor = block.impulse;
    }
  }
  snapshot_.give_back(problem);
  outcome.miss = best;
  return enough;
}

}  // namespace ziggurat::dynamics
