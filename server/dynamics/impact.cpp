#include "dynamics/impact.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace ziggurat::dynamics {
namespace {

/// Slower impacts do not bounce [m/s].
constexpr double slowest_bounce = 0.05;
/// Larger trees and islands are not looked at for what they do not come to meet.
constexpr int most_dofs = 32;
constexpr std::size_t most_blocks = 300;

using Impulse = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_dofs, 1>;
using Mass = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, most_dofs, most_dofs>;

/// Notes which trees what touches them from below carries.
void find_carried(Problem& problem) {
  constexpr double resting = 1e-3;  // what parts faster does not carry any more [m/s]
  problem.carried.assign(problem.trees.size(), 0.0);
  for (const Block& block : problem.blocks) {
    if (block.kind != Block::Source::contact || block.impulse[0] == 0 || block.gap > problem.allowed_overlap) continue;
    double u[Block::most_rows];
    problem.speeds(block, u);
    if (u[0] > resting) continue;
    Vector3 push = Vector3::Zero();
    for (int r = 0; r < std::min(block.rows, 3); ++r) push += block.impulse[r] * block.frame.col(r);
    if (block.a >= 0) problem.carried[block.a] -= push.dot(problem.trees[block.a]->gravity);
    if (block.b >= 0) problem.carried[block.b] += push.dot(problem.trees[block.b]->gravity);
  }
}

/// What a tree falls with [m/s^2].
Vector3 fall_of(const Problem& problem, int place) {
  if (place < 0 || !problem.trees[place]->free_root) return Vector3::Zero();
  const Vector3& gravity = problem.trees[place]->gravity;
  const double all = problem.length * problem.total_mass[place] * gravity.squaredNorm();
  return problem.carried[place] > all / 2 ? Vector3(Vector3::Zero()) : gravity;
}

/// When in the substep surfaces meet, and with which speed and how far apart they are at its end.
void aim(const Problem& problem, Block& block) {
  double before[Block::most_rows];
  problem.speeds(block, before);
  const double pull = block.frame.col(0).dot(fall_of(problem, block.a) - fall_of(problem, block.b));  // apart: > 0
  const double gap = std::max(0.0, block.gap);
  const double square = before[0] * before[0] - 2 * pull * gap;  // of the speed of the impact
  if (square < slowest_bounce * slowest_bounce) return;
  const double impact = std::sqrt(square);
  if (impact <= before[0]) return;  // they part
  const double time = 2 * gap / (impact - before[0]), rest = problem.length - time;
  if (rest <= 0) {  // not yet: nothing may hold it
    block.seek[0] = std::min(block.seek[0], before[0] + problem.length * pull);
    return;
  }
  const double rise = rest * (block.restitution * impact + rest * pull / 2);
  if (rise <= 0) return;
  block.bounces = true;
  block.yield = 0;
  block.met = time;
  block.rise = rise;
  block.before = -impact - rest * pull;
  block.seek[0] = block.restitution * impact + rest * pull;
}

/// The normal row of a block for a tree: zero if it is not a side of it.
Impulse normal_row(const Problem& problem, const Block& block, int tree) {
  Impulse row = Impulse::Zero(problem.trees[tree]->dofs);
  const auto add = [&](int place, int first) {
    for (int k = 0; place == tree && k < row.size(); ++k) row[k] += problem.jacobian[first + k * block.rows];
  };
  add(block.a, block.ja);
  add(block.b, block.jb);
  return row;
}

/// What a unit of an impact's impulse changes of another contact's speed [1/kg].
double response(const Problem& problem, const Block& impact, const Block& other) {
  double sum = 0;
  for (const int tree : {impact.a, impact.b}) {
    if (tree < 0 || (tree != other.a && tree != other.b)) continue;
    const int dofs = problem.trees[tree]->dofs;
    const Mass mass = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(problem.mass_of(tree), dofs, dofs);
    sum += normal_row(problem, other, tree).dot(mass.llt().solve(normal_row(problem, impact, tree)));
  }
  return sum;
}

/// Whether a contact is still met when another one, which is met earlier, has rebounded: a ball on a plate does not reach the
/// floor below that.
bool is_met_after(const Problem& problem, const Block& later, const Block& earlier) {
  const auto is_large = [&](int tree) { return tree >= 0 && problem.trees[tree]->dofs > most_dofs; };
  if (is_large(earlier.a) || is_large(earlier.b)) return true;
  const double own = response(problem, earlier, earlier), cross = response(problem, earlier, later);
  if (!(own > 0) || cross <= 0) return true;
  double now[Block::most_rows], impact[Block::most_rows];
  problem.speeds(later, now);
  problem.speeds(earlier, impact);
  const double change = cross / own * (earlier.seek[0] - impact[0]);
  return later.gap + earlier.met * now[0] + (problem.length - earlier.met) * (now[0] + change) < 0;
}

/// Lets contacts with restitution seek the speeds with which they rebound, and end where they do.
void aim_rebounds(Problem& problem) {
  const auto rebounds = [](const Block& block) { return block.restitution > 0; };
  if (std::ranges::none_of(problem.blocks, rebounds)) return;
  find_carried(problem);
  for (Block& block : problem.blocks) {
    if (rebounds(block)) aim(problem, block);
  }
  if (problem.blocks.size() > most_blocks) return;
  for (Block& block : problem.blocks) {
    const auto hides_it = [&](const Block& other) {
      const auto shares = [&](int tree) { return tree >= 0 && (tree == block.a || tree == block.b); };
      return other.bounces && other.met < block.met && (shares(other.a) || shares(other.b)) && !is_met_after(problem, block, other);
    };
    if (!block.bounces || std::ranges::none_of(problem.blocks, hides_it)) continue;
    block.bounces = false;
    block.seek[0] = -block.gap / problem.length;
  }
}

}  // namespace

Outcome solve_velocities(Problem& problem, Solver& solver) {
  aim_rebounds(problem);
  problem.bound_depth();
  return solver.solve(problem);
}

}  // namespace ziggurat::dynamics
