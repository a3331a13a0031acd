#include "dynamics/sequential_impacts.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "dynamics/constraint.h"

namespace ziggurat::dynamics {
namespace {

constexpr double still = 1e-9;  // what is slower does not come nearer [m/s]

using Row = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_dofs_struck, 1>;
using Mass = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, most_dofs_struck, most_dofs_struck>;

/// Of a block's first speed, for a tree: zero if it is not a side of it.
Row row_of(const Problem& problem, const Block& block, int tree) {
  Row row = Row::Zero(problem.trees[tree]->dofs);
  const auto add = [&](int place, int first) {
    for (int k = 0; place == tree && k < row.size(); ++k) row[k] += problem.jacobian[first + k * block.rows];
  };
  add(block.a, block.ja);
  add(block.b, block.jb);
  return row;
}

/// The contacts of an island while its impacts take place.
struct Sequence {
  double length = 0, time = 0;             ///< of the substep, and since its beginning [s]
  std::vector<double> gap, speed, pull;    ///< of each contact [m], [m/s], [m/s^2]
  std::vector<double> given, worked, met;  ///< impulse, its work, and when it last met [N s], [J], [s]
  Eigen::MatrixXd responses;               ///< of a contact's speed (row) to an impulse at another [1/kg]
};

/// When surfaces meet, from now on [s]; infinite: they part, or rest on each other.
double time_to(const Sequence& s, std::size_t i) {
  const double gap = s.gap[i], speed = s.speed[i], pull = s.pull[i];
  if (gap <= 0) {
    if (speed < -still) return 0;
    return speed > slow_impact && pull < 0 ? -2 * speed / pull : HUGE_VAL;
  }
  const double square = speed * speed - 2 * pull * gap;  // of the speed of the impact
  if (square <= 0 || (speed >= 0 && pull >= 0)) return HUGE_VAL;
  return 2 * gap / (std::sqrt(square) - speed);
}

void advance(Sequence& s, double time) {
  for (std::size_t i = 0; i < s.gap.size(); ++i) {
    s.gap[i] += time * (s.speed[i] + time * s.pull[i] / 2);
    s.speed[i] += time * s.pull[i];
  }
  s.time += time;
}

/// Lets some contacts rebound at once; those that this would pull are left out.
void strike(Sequence& s, std::span<const Impact> impacts, std::vector<int> together) {
  Eigen::VectorXd impulse;
  for (;;) {
    const auto count = static_cast<Eigen::Index>(together.size());
    Eigen::MatrixXd matrix(count, count);
    Eigen::VectorXd change(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const double speed = s.speed[together[i]], bounce = -speed < slow_impact ? 0 : impacts[together[i]].block->restitution;
      change[i] = -(1 + bounce) * speed;
      for (Eigen::Index k = 0; k < count; ++k) matrix(i, k) = s.responses(together[i], together[k]);
    }
    impulse = matrix.fullPivLu().solve(change);
    Eigen::Index least = 0;
    if (impulse.minCoeff(&least) >= 0 || count == 1) break;
    together.erase(together.begin() + least);
  }
  for (std::size_t i = 0; i < together.size(); ++i) s.worked[together[i]] += impulse[i] * s.speed[together[i]] / 2;
  for (std::size_t k = 0; k < s.speed.size(); ++k) {
    for (std::size_t i = 0; i < together.size(); ++i) s.speed[k] += s.responses(k, together[i]) * impulse[i];
  }
  for (std::size_t i = 0; i < together.size(); ++i) {
    s.worked[together[i]] += impulse[i] * s.speed[together[i]] / 2;
    s.given[together[i]] += impulse[i];
    s.met[together[i]] = s.time;
  }
}

Sequence begin(const Problem& problem, std::span<const Impact> impacts) {
  Sequence s;
  s.length = problem.length;
  const auto count = impacts.size();
  s.given.resize(count), s.worked.resize(count), s.met.resize(count);
  s.responses.resize(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(count));
  for (std::size_t i = 0; i < count; ++i) {
    s.gap.push_back(impacts[i].block->gap);
    s.speed.push_back(impacts[i].speed);
    s.pull.push_back(impacts[i].pull);
    for (std::size_t k = 0; k < count; ++k) s.responses(i, k) = response(problem, *impacts[k].block, *impacts[i].block);
  }
  return s;
}

}  // namespace

double response(const Problem& problem, const Block& impulse, const Block& speed) {
  double sum = 0;
  for (const int tree : {impulse.a, impulse.b}) {
    if (tree < 0 || (tree != speed.a && tree != speed.b)) continue;
    const int dofs = problem.trees[tree]->dofs;
    const Mass mass = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(problem.mass_of(tree), dofs, dofs);
    sum += row_of(problem, speed, tree).dot(mass.llt().solve(row_of(problem, impulse, tree)));
  }
  return sum;
}

bool take_in_turn(Problem& problem, std::span<const Impact> impacts) {
  constexpr double more_than_missed = 1e-6;  // by the solver [m/s]
  Sequence s = begin(problem, impacts);
  const double moment = 1e-9 * s.length;  // what is nearer takes place together
  int left = 64 * static_cast<int>(impacts.size()), struck = 0;
  std::vector<int> together;
  for (; left > 0; --left) {
    double next = HUGE_VAL;
    for (std::size_t i = 0; i < impacts.size(); ++i) next = std::min(next, time_to(s, i));
    if (s.time + next >= s.length) break;
    together.clear();
    for (std::size_t i = 0; i < impacts.size(); ++i) {
      if (time_to(s, i) <= next + moment) together.push_back(static_cast<int>(i));
    }
    advance(s, next);
    strike(s, impacts, together);
    ++struck;
  }
  if (struck == 0 || left == 0) return false;
  problem.in_turn = true;
  advance(s, s.length - s.time);
  for (std::size_t i = 0; i < impacts.size(); ++i) {
    Block& block = *impacts[i].block;
    if (s.given[i] == 0) {  // nothing may hold it
      block.seek[0] = std::min(block.seek[0], s.speed[i] - more_than_missed);
      continue;
    }
    block.bounces = true;
    block.yield = 0;
    block.met = s.met[i];
    block.rise = std::max(0.0, s.gap[i]);
    block.seek[0] = s.speed[i];
    block.before = 2 * s.worked[i] / s.given[i] - s.speed[i];
  }
  return true;
}

}  // namespace ziggurat::dynamics
