// SPDX-License-Identifier: MIT
#include "physics/solver/newton.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "physics/solver/constraint_hessian.h"

namespace ziggurat::dynamics {
namespace {

using Speeds = std::vector<std::array<double, Constraint::most_rows>>;

/// Sets a constraint's impulses by its linearised law.
template <int R>
void set_impulse(const LinearisedLaw& linear, const double* u, Constraint& constraint) {
  for (int r = 0; r < R; ++r) {
    double sum = linear.constant[r];
    for (int c = 0; c < R; ++c) sum -= linear.hessian[r * R + c] * u[c];
    constraint.impulse[r] = sum;
  }
}

/// Changes a constraint's impulses by its linearised law, from velocities u to w.
template <int R>
void change_impulse(const LinearisedLaw& linear, const double* u, const double* w,
                    Constraint& constraint) {
  double change[R];
  for (int c = 0; c < R; ++c) change[c] = w[c] - u[c];
  for (int r = 0; r < R; ++r) {
    double sum = constraint.impulse[r];
    for (int c = 0; c < R; ++c) sum -= linear.hessian[r * R + c] * change[c];
    constraint.impulse[r] = sum;
  }
}

/// Sum of a constraint's speeds and impulses, NaN if one of them is.
/// @param scale  grows to the largest speed, or change of speed by an impulse
template <int R>
double add_to_scale(const Constraint& constraint, const double* u, double& scale) {
  double sum = 0;
  for (int r = 0; r < R; ++r) {
    const double speed = std::abs(u[r]), impulse = std::abs(constraint.impulse[r]);
    sum += speed + impulse;
    scale = std::max(scale, std::max(speed, impulse * constraint.mobility[r]));
  }
  return sum;
}

/// Finds the scale of speeds in an island.
/// @param scale      out: the largest speed of contacts, or change of speed by an impulse; of
///                   servos and limits if there is no contact
/// @param of_joints  out: of servos and limits
/// @return           false if a speed or an impulse is not finite
bool find_scale(const Problem& problem, const Speeds& speeds, double& scale, double& of_joints) {
  double sum = 0;
  scale = of_joints = 0;
  for (std::size_t i = 0; i < problem.constraints.size(); ++i) {
    const Constraint& constraint = problem.constraints[i];
    dispatch_rows(constraint.rows, [&](auto rows) {
      sum += add_to_scale<rows()>(constraint, speeds[i].data(),
                                  constraint.kind == Constraint::Kind::contact ? scale : of_joints);
    });
  }
  if (scale == 0) scale = of_joints;
  return std::isfinite(sum);  // the maxima skip NaN
}

/// Largest residual of the constraints.
/// @param enough  larger residuals need not be exact
double residual_beyond(const Problem& problem, const Speeds& speeds, double enough) {
  double worst = 0;
  for (std::size_t i = 0; i < problem.constraints.size() && worst <= enough; ++i) {
    worst = std::max(worst, residual(problem.constraints[i], speeds[i].data()));
  }
  return worst;
}

/// Merit function of all constraints, see contact_law.h [J].
double merit(const Problem& problem, const Speeds& speeds) {
  double sum = 0;
  for (std::size_t i = 0; i < problem.constraints.size(); ++i) {
    sum += dynamics::merit(problem.constraints[i], speeds[i].data());
  }
  return sum;
}

/// Whether masses are so similar that one tolerance of speeds suits all trees.
bool have_similar_masses(std::span<const double> masses) {
  constexpr double most = 100;  // the heaviest over the lightest
  const auto [least, greatest] = std::ranges::minmax(masses);
  return greatest <= most * least;
}

/// Initial velocities of an unsolved problem.
InitialVelocities initial_velocities(const Problem& problem, const Speeds& speeds) {
  InitialVelocities out;
  for (std::size_t i = 0; i < problem.constraints.size(); ++i) {
    if (problem.constraints[i].kind != Constraint::Kind::contact) continue;
    for (int r = 0; r < std::min(problem.constraints[i].rows, 3); ++r)
      out.fastest_contact = std::max(out.fastest_contact, std::abs(speeds[i][r]));
  }
  for (const Tree* tree : problem.trees)
    out.gravity_change = std::max(out.gravity_change, problem.time_step * tree->gravity.norm());
  return out;
}

}  // namespace

void assemble_mass(const Problem& problem, BlockMatrix& matrix) {
  matrix.clear();
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    const Tree& tree = *problem.trees[i];
    double* block = matrix.block(static_cast<int>(i), static_cast<int>(i));
    std::copy_n(problem.mass_of(i), tree.dofs * tree.dofs, block);
    for (int k = 0; k < tree.dofs; ++k) {
      block[k * tree.dofs + k] += problem.time_step * tree.damping[k];
    }
  }
}

/// Computes the velocities u of all constraints at the present velocities.
void VelocitySolver::compute_constraint_velocities(const Problem& problem) {
  constraint_velocities_.resize(problem.constraints.size());
  for (std::size_t i = 0; i < constraint_velocities_.size(); ++i) {
    problem.constraint_velocity(problem.constraints[i], constraint_velocities_[i].data());
  }
}

/// One step of Newton's method. Constraint velocities must be valid, and are updated.
/// @return  false if the matrix is singular; then nothing has changed
bool VelocitySolver::newton_step(Problem& problem) {
  kept_velocity_ = problem.velocity;
  assemble_mass(problem, matrix_);
  problem.velocity = problem.momentum;
  for (std::size_t i = 0; i < problem.constraints.size(); ++i) {
    linearise(problem.constraints[i], constraint_velocities_[i].data(), laws_[i]);
    add_constraint_hessian(problem, problem.constraints[i], laws_[i], hessian_jacobian_, matrix_);
    if (laws_[i].is_zero) continue;
    add_impulse(problem, problem.constraints[i], laws_[i].constant.data(), problem.velocity);
  }
  if (!matrix_.factor()) {
    problem.velocity = kept_velocity_;
    return false;
  }
  matrix_.solve(problem.velocity.data());
  compute_constraint_velocities(problem);
  for (std::size_t i = 0; i < problem.constraints.size(); ++i) {
    Constraint& constraint = problem.constraints[i];
    const LinearisedLaw& linear = laws_[i];
    if (linear.is_zero) {
      constraint.impulse.fill(0);
      continue;
    }
    dispatch_rows(constraint.rows, [&](auto rows) {
      set_impulse<rows()>(linear, constraint_velocities_[i].data(), constraint);
    });
  }
  return true;
}

/// One step of the simplified Newton method, with the last factors: near the solution the matrix
/// hardly changes. Constraint velocities must be valid, and are updated.
void VelocitySolver::simplified_newton_step(Problem& problem) {
  for (std::size_t i = 0; i < problem.constraints.size(); ++i) {
    Constraint& constraint = problem.constraints[i];
    linearise(constraint, constraint_velocities_[i].data(), law_);
    if (law_.is_zero) {
      constraint.impulse.fill(0);
      continue;
    }
    dispatch_rows(constraint.rows, [&](auto rows) {
      set_impulse<rows()>(law_, constraint_velocities_[i].data(), constraint);
    });
  }
  momentum_residual(problem, residual_);
  kept_constraint_velocities_ = constraint_velocities_;
  matrix_.solve(residual_.data());
  for (std::size_t k = 0; k < residual_.size(); ++k) problem.velocity[k] += residual_[k];
  compute_constraint_velocities(problem);
  for (std::size_t i = 0; i < problem.constraints.size(); ++i) {
    if (laws_[i].is_zero) continue;
    dispatch_rows(problem.constraints[i].rows, [&](auto rows) {
      change_impulse<rows()>(laws_[i], kept_constraint_velocities_[i].data(),
                             constraint_velocities_[i].data(), problem.constraints[i]);
    });
  }
}

/// Residual at the present constraint velocities.
/// @param scale  out: see find_scale()
/// @return       infinite if a speed or an impulse is not finite
double VelocitySolver::current_residual(const Problem& problem, double& scale) const {
  double of_joints = 0;
  return find_scale(problem, constraint_velocities_, scale, of_joints)
             ? residual_beyond(problem, constraint_velocities_, HUGE_VAL)
             : HUGE_VAL;
}

void Iterate::save(const Problem& problem) {
  velocity = problem.velocity;
  impulses.clear();
  for (const Constraint& constraint : problem.constraints) impulses.push_back(constraint.impulse);
}

void Iterate::restore(Problem& problem) const {
  problem.velocity = velocity;
  for (std::size_t i = 0; i < impulses.size(); ++i) problem.constraints[i].impulse = impulses[i];
}

void Iterate::backtrack(Problem& problem, double share) const {
  for (std::size_t k = 0; k < velocity.size(); ++k) {
    problem.velocity[k] += share * (velocity[k] - problem.velocity[k]);
  }
  for (std::size_t i = 0; i < impulses.size(); ++i) {
    for (int r = 0; r < problem.constraints[i].rows; ++r) {
      double& impulse = problem.constraints[i].impulse[r];
      impulse += share * (impulses[i][r] - impulse);
    }
  }
}

/// Line search: halves a step of Newton's method from `earlier_` until the merit function falls.
/// @param wrong  merit before; out: after
void VelocitySolver::line_search(Problem& problem, double& wrong) {
  constexpr int most = 6;
  const double before = wrong;
  for (int i = 0; i <= most; ++i) {
    wrong = merit(problem, constraint_velocities_);
    if (wrong < before || i == most) return;
    earlier_.backtrack(problem, 0.5);
    compute_constraint_velocities(problem);
  }
}

/// Steps of the simplified Newton method.
/// @return  whether they converged; otherwise the problem holds the best iterate
bool VelocitySolver::simplified_newton(Problem& problem, SolverResult& outcome) {
  constexpr int most = 3;
  constexpr double much = 0.1;  // less progress: new factors are worth their time
  double scale = 0;
  for (int i = 0; i < most; ++i) {
    const double before = outcome.residual;
    earlier_.save(problem);
    simplified_newton_step(problem);
    outcome.residual = current_residual(problem, scale);
    if (outcome.residual <= options.tolerance(scale)) return true;
    if (outcome.residual > before) {  // with redundant contacts it may diverge
      earlier_.restore(problem);
      compute_constraint_velocities(problem);
      outcome.residual = before;
    }
    if (outcome.residual > much * before) return false;
  }
  return false;
}

/// Newton's method from the present state, whose constraint velocities are computed. From the third
/// step on it has a line search on the merit function. Without it the method cycles where a
/// saturated motor's wheel alternates between sticking and sliding.
/// @param most_far  stalled iterations with a large residual
/// @return          whether it converged; then the problem holds the solution
bool VelocitySolver::newton(Problem& problem, SolverResult& outcome, int most_far) {
  double scale = 0, wrong = HUGE_VAL;
  int far = 0;
  for (int i = 0; i < options.most_iterations; ++i) {
    const bool shortens = i > 1;
    const double wrong_before = wrong;
    if (shortens) earlier_.save(problem);
    if (!newton_step(problem)) return false;
    ++outcome.iterations;
    if (shortens) line_search(problem, wrong);
    outcome.residual = current_residual(problem, scale);
    if (outcome.residual <= options.tolerance(scale)) return true;
    if (!shortens) wrong = merit(problem, constraint_velocities_);
    const bool nears = wrong < 0.5 * wrong_before;
    if (outcome.residual > options.stalled_residual * scale && !nears && ++far >= most_far)
      return false;
    if (outcome.residual <= options.rounding * scale && !nears) return true;
    if (outcome.residual > options.simplified_newton_residual * scale) continue;
    if (simplified_newton(problem, outcome)) return true;
    wrong = merit(problem, constraint_velocities_);
  }
  return false;
}

/// Analyses the matrix, if it is not too large for that, and saves the state. Constraint velocities
/// must be valid.
/// @return  multiplications that a factorisation takes
double VelocitySolver::analyse(Problem& problem) {
  start_.save(problem);
  initial_ = initial_velocities(problem, constraint_velocities_);
  if (problem.trees.size() > options.most_factored_trees) return HUGE_VAL;
  sizes_.clear();
  for (const Tree* tree : problem.trees) sizes_.push_back(tree->dofs);
  matrix_.shape(sizes_, problem.couplings);
  laws_.resize(problem.constraints.size());
  return matrix_.work();
}

/// Whether the last substep's velocities and impulses still solve the problem.
bool VelocitySolver::is_warm_start_solved(const Problem& problem, SolverResult& outcome) {
  double scale = 0, of_joints = 0;
  compute_constraint_velocities(problem);
  const bool finite = find_scale(problem, constraint_velocities_, scale, of_joints);
  const double enough = options.tolerance(scale);
  outcome.residual = finite ? residual_beyond(problem, constraint_velocities_, enough) : HUGE_VAL;
  if (outcome.residual > enough) return false;
  const double balanced =
      options.absolute_tolerance + options.warm_start_tolerance * std::max(scale, of_joints);
  if (momentum_residual(problem, residual_) > balanced) return false;
  return have_similar_masses(problem.total_mass) ||
         is_momentum_balanced(problem, residual_, options.warm_start_tolerance,
                              options.absolute_tolerance, impulse_sum_);
}

}  // namespace ziggurat::dynamics
