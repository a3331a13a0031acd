// Sweeps over contacts (non-smooth Gauss-Seidel: M. Jean, Comput. Methods Appl. Mech. Eng. 177,
// 1999): each in turn takes the impulses that its law wants with all others as they are.

#include <algorithm>
#include <cmath>

#include "dynamics/equations.h"
#include "dynamics/newton.h"

namespace ziggurat::dynamics {
namespace {

void add_to(Problem& problem, int place, const double* columns, int rows, const double* impulse) {
  double* v = problem.velocity.data() + problem.offset[place];
  const int dofs = problem.trees[place]->dofs;
  for (int k = 0; k < dofs; ++k) {
    double sum = 0;
    for (int r = 0; r < rows; ++r) sum += columns[k * rows + r] * impulse[r];
    v[k] += sum;
  }
}

}  // namespace

/// Responses M^-1 J^T of all blocks, and the velocities that belong to their impulses.
void Solver::prepare_sweeps(Problem& problem) {
  for (Tree* tree : problem.trees) factor_mass(*tree, problem.length);
  response_.resize(problem.jacobian.size());
  diagonal_.assign(problem.blocks.size() * Block::most_rows, 0);
  problem.velocity = problem.momentum;
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    solve_mass(*problem.trees[i], problem.velocity.data() + problem.offset[i]);
  }
  for (std::size_t i = 0; i < problem.blocks.size(); ++i) {
    const Block& block = problem.blocks[i];
    const int sides[] = {block.a, block.b}, first[] = {block.ja, block.jb};
    for (int s = 0; s < 2; ++s) {
      if (sides[s] < 0) continue;
      Tree& tree = *problem.trees[sides[s]];
      for (int r = 0; r < block.rows; ++r) {
        double* x = tree.scratch.data();
        for (int k = 0; k < tree.dofs; ++k) x[k] = problem.jacobian[first[s] + k * block.rows + r];
        solve_mass(tree, x);
        for (int k = 0; k < tree.dofs; ++k) {
          const int at = first[s] + k * block.rows + r;
          response_[at] = x[k];
          diagonal_[i * Block::most_rows + r] += x[k] * problem.jacobian[at];
        }
      }
      add_to(problem, sides[s], response_.data() + first[s], block.rows, block.impulse.data());
    }
  }
}

void Solver::sweep_block(Problem& problem, Block& block, std::size_t index) {
  const double* diagonal = diagonal_.data() + index * Block::most_rows;
  double u[Block::most_rows], change[Block::most_rows], wanted[Block::most_rows];
  // The normal first, then friction with what the normal has become.
  for (int part = 0; part < (block.rows > 1 ? 2 : 1); ++part) {
    problem.speeds(block, u);
    std::copy_n(block.impulse.begin(), block.rows, wanted);
    for (int r = part == 0 ? 0 : 1; r < (part == 0 ? 1 : block.rows); ++r) {
      // Both rows of a disc step alike: along the slip.
      double mobility = diagonal[r];
      if (r == 1 || r == 4) mobility = std::max(diagonal[r], diagonal[r + 1]);
      if (r == 2 || r == 5) mobility = std::max(diagonal[r - 1], diagonal[r]);
      if (mobility > 0) wanted[r] -= (u[r] - block.seek[r]) / mobility;
    }
    clip(block, wanted);
    for (int r = 0; r < block.rows; ++r) {
      const bool moves = part == 0 ? r == 0 : r > 0;
      change[r] = moves ? wanted[r] - block.impulse[r] : 0;
      block.impulse[r] += change[r];
    }
    const int sides[] = {block.a, block.b}, first[] = {block.ja, block.jb};
    for (int s = 0; s < 2; ++s) {
      if (sides[s] < 0) continue;
      add_to(problem, sides[s], response_.data() + first[s], block.rows, change);
    }
    if (block.law == Block::Law::bounded) break;
  }
}

void Solver::sweep_until_converged(Problem& problem, Outcome& outcome, int most) {
  prepare_sweeps(problem);
  double scale = 0;
  for (int sweep = 0; sweep < most; ++sweep) {
    ++outcome.sweeps;
    const std::size_t count = problem.blocks.size();
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t at = sweep % 2 ? count - 1 - i : i;
      if (problem.blocks[at].law != Block::Law::off) sweep_block(problem, problem.blocks[at], at);
    }
    if (sweep % 5 != 4 && sweep + 1 < most) continue;
    outcome.miss = worst_miss(problem, scale);
    outcome.converged =
        outcome.miss <= options.absolute_tolerance + options.soft_tolerance * scale;
    if (outcome.converged) return;
  }
}

}  // namespace ziggurat::dynamics
