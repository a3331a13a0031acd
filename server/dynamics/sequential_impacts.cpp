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

/// Jacobian row of a constraint's first velocity for a tree: zero if the constraint does not act on
/// it.
Row row_of(const Problem& problem, const Constraint& constraint, int tree) {
  Row row = Row::Zero(problem.trees[tree]->dofs);
  const auto add = [&](int index, int first) {
    for (int k = 0; index == tree && k < row.size(); ++k) row[k] += problem.jacobian[first + k * constraint.rows];
  };
  add(constraint.a, constraint.jacobian_a);
  add(constraint.b, constraint.jacobian_b);
  return row;
}

/// The contacts of an island while its impacts take place.
struct ImpactSequence {
  double time_step = 0, time = 0;             ///< of the substep, and since its beginning [s]
  std::vector<double> gap, speed, pull;    ///< of each contact [m], [m/s], [m/s^2]
  std::vector<double> given, met;  ///< impulse, and when it last met [N s], [s]
  Eigen::MatrixXd responses;               ///< of a contact's speed (row) to an impulse at another [1/kg]
};

/// When surfaces meet, from now on [s]; infinite: they part, or rest on each other.
double time_to(const ImpactSequence& s, std::size_t i) {
  const double gap = s.gap[i], speed = s.speed[i], pull = s.pull[i];
  if (gap <= 0) {
    if (speed < -still) return 0;
    return speed > restitution_threshold && pull < 0 ? -2 * speed / pull : HUGE_VAL;
  }
  const double square = speed * speed - 2 * pull * gap;  // of the speed of the impact
  if (square <= 0 || (speed >= 0 && pull >= 0)) return HUGE_VAL;
  return 2 * gap / (std::sqrt(square) - speed);
}

void advance(ImpactSequence& s, double time) {
  for (std::size_t i = 0; i < s.gap.size(); ++i) {
    s.gap[i] += time * (s.speed[i] + time * s.pull[i] / 2);
    s.speed[i] += time * s.pull[i];
  }
  s.time += time;
}

/// Lets some contacts rebound at once; those that this would pull are left out.
void strike(ImpactSequence& s, std::span<const RestitutionContact> impacts, std::vector<int> together) {
  Eigen::VectorXd impulse;
  for (;;) {
    const auto count = static_cast<Eigen::Index>(together.size());
    Eigen::MatrixXd matrix(count, count);
    Eigen::VectorXd change(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const double speed = s.speed[together[i]], bounce = -speed < restitution_threshold ? 0 : impacts[together[i]].constraint->restitution;
      change[i] = -(1 + bounce) * speed;
      for (Eigen::Index k = 0; k < count; ++k) matrix(i, k) = s.responses(together[i], together[k]);
    }
    impulse = matrix.fullPivLu().solve(change);
    Eigen::Index least = 0;
    if (impulse.minCoeff(&least) >= 0 || count == 1) break;
    together.erase(together.begin() + least);
  }
  for (std::size_t k = 0; k < s.speed.size(); ++k) {
    for (std::size_t i = 0; i < together.size(); ++i) s.speed[k] += s.responses(k, together[i]) * impulse[i];
  }
  for (std::size_t i = 0; i < together.size(); ++i) {
    s.given[together[i]] += impulse[i];
    s.met[together[i]] = s.time;
  }
}

ImpactSequence begin(const Problem& problem, std::span<const RestitutionContact> impacts) {
  ImpactSequence s;
  s.time_step = problem.time_step;
  const auto count = impacts.size();
  s.given.resize(count), s.met.resize(count);
  s.responses.resize(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(count));
  for (std::size_t i = 0; i < count; ++i) {
    s.gap.push_back(impacts[i].constraint->gap);
    s.speed.push_back(impacts[i].speed);
    s.pull.push_back(impacts[i].pull);
    for (std::size_t k = 0; k < count; ++k) s.responses(i, k) = response(problem, *impacts[k].constraint, *impacts[i].constraint);
  }
  return s;
}

}  // namespace

double response(const Problem& problem, const Constraint& impulse, const Constraint& speed) {
  double sum = 0;
  for (const int tree : {impulse.a, impulse.b}) {
    if (tree < 0 || (tree != speed.a && tree != speed.b)) continue;
    const int dofs = problem.trees[tree]->dofs;
    const Mass mass = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(problem.mass_of(tree), dofs, dofs);
    sum += row_of(problem, speed, tree).dot(mass.llt().solve(row_of(problem, impulse, tree)));
  }
  return sum;
}

bool resolve_in_time_order(Problem& problem, std::span<const RestitutionContact> impacts) {
  constexpr double residual_margin = 1e-6;  // by the solver [m/s]
  ImpactSequence s = begin(problem, impacts);
  const double moment = 1e-9 * s.time_step;  // what is nearer takes place together
  int left = 64 * static_cast<int>(impacts.size()), struck = 0;
  std::vector<int> together;
  for (; left > 0; --left) {
    double next = HUGE_VAL;
    for (std::size_t i = 0; i < impacts.size(); ++i) next = std::min(next, time_to(s, i));
    if (s.time + next >= s.time_step) break;
    together.clear();
    for (std::size_t i = 0; i < impacts.size(); ++i) {
      if (time_to(s, i) <= next + moment) together.push_back(static_cast<int>(i));
    }
    advance(s, next);
    strike(s, impacts, together);
    ++struck;
  }
  if (struck == 0 || left == 0) return false;
  problem.has_sequential_impacts = true;
  advance(s, s.time_step - s.time);
  for (std::size_t i = 0; i < impacts.size(); ++i) {
    Constraint& constraint = *impacts[i].constraint;
    if (s.given[i] == 0) {  // nothing may hold it
      constraint.target_velocity[0] = std::min(constraint.target_velocity[0], s.speed[i] - residual_margin);
      continue;
    }
    constraint.has_impact = true;
    constraint.compliance = 0;
    constraint.impact_time = s.met[i];
    constraint.target_gap = std::max(0.0, s.gap[i]);
    constraint.target_velocity[0] = s.speed[i];
  }
  return true;
}

}  // namespace ziggurat::dynamics
