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
  if (rows == 3) {
    for (int k = 0; k < dofs; ++k, columns += 3) {
      v[k] += columns[0] * impulse[0] + columns[1] * impulse[1] + columns[2] * impulse[2];
    }
    return;
  }
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
  coupling_.assign(problem.blocks.size() * 2, 0);
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
        if (r > 0 || block.rows != 3) continue;
        for (int k = 0; k < tree.dofs; ++k) {
          coupling_[2 * i] += x[k] * problem.jacobian[first[s] + k * 3 + 1];
          coupling_[2 * i + 1] += x[k] * problem.jacobian[first[s] + k * 3 + 2];
        }
      }
      add_to(problem, sides[s], response_.data() + first[s], block.rows, block.impulse.data());
    }
  }
}

/// A contact with sliding friction: the normal impulse, then friction at the speed that it leaves.
void Solver::sweep_contact(Problem& problem, Block& block, std::size_t index) {
  const double* diagonal = diagonal_.data() + index * Block::most_rows;
  double u[3];
  problem.speeds(block, u);
  const double normal = block.impulse[0] - (u[0] - block.seek[0]) / diagonal[0];
  if (normal <= 0 && block.impulse[0] == 0) return;
  double change[3] = {std::max(0.0, normal) - block.impulse[0], 0, 0};
  block.impulse[0] += change[0];
  double wanted[2], square = 0;
  const double mobility = std::max(diagonal[1], diagonal[2]);  // both rows alike: along the slip
  for (int r = 0; r < 2; ++r) {
    const double slip = u[1 + r] + coupling_[2 * index + r] * change[0] - block.seek[1 + r];
    wanted[r] = block.impulse[1 + r] - slip / mobility;
    square += wanted[r] * wanted[r];
  }
  const double bound = block.friction * block.impulse[0];
  const double factor = square > bound * bound ? bound / std::sqrt(square) : 1;
  for (int r = 0; r < 2; ++r) {
    change[1 + r] = factor * wanted[r] - block.impulse[1 + r];
    block.impulse[1 + r] += change[1 + r];
  }
  if (block.a >= 0) add_to(problem, block.a, response_.data() + block.ja, 3, change);
  if (block.b >= 0) add_to(problem, block.b, response_.data() + block.jb, 3, change);
}

void Solver::sweep_block(Problem& problem, Block& block, std::size_t index) {
  if (block.law == Block::Law::contact && block.rows == 3) {
    return sweep_contact(problem, block, index);
  }
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
