// SPDX-License-Identifier: MIT
// Augmented Lagrangian: Newton's method on the regularised problem about multipliers, the impulses
// known so far. From the last substep's impulses a heap at rest takes one step.

#include <algorithm>
#include <cmath>

#include "physics/solver/constraint_hessian.h"
#include "physics/solver/newton.h"

namespace ziggurat::dynamics {

/// out += J^T impulse of a constraint.
void add_impulse(const Problem& problem, const Constraint& constraint, const double* impulse,
                 std::vector<double>& out) {
  const auto add_side = [&](int index, int first, std::span<const int> dofs) {
    if (index < 0) return;
    dispatch_rows(constraint.rows, [&](auto rows) {
      add_impulse<rows()>(problem.jacobian.data() + first, dofs, impulse,
                          out.data() + problem.offset[index]);
    });
  };
  add_side(constraint.a, constraint.jacobian_a, constraint.dofs_a);
  add_side(constraint.b, constraint.jacobian_b, constraint.dofs_b);
}

namespace {

/// Whether a constraint has an impulse.
bool has_impulse(const Constraint& constraint) {
  return std::any_of(constraint.impulse.begin(), constraint.impulse.begin() + constraint.rows,
                     [](double impulse) { return impulse != 0; });
}

}  // namespace

/// Momentum residual: out := p + J^T g - M v, with the joints' damping in M.
/// @return  the largest residual velocity of a coordinate, about [m/s] or [rad/s]
double momentum_residual(const Problem& problem, std::vector<double>& out) {
  out = problem.momentum;
  for (const Constraint& constraint : problem.constraints) {
    if (has_impulse(constraint)) add_impulse(problem, constraint, constraint.impulse.data(), out);
  }
  double worst = 0;
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    const Tree& tree = *problem.trees[i];
    const int n = tree.dofs;
    const double* mass = problem.mass_of(i);
    const double* v = problem.velocity.data() + problem.offset[i];
    double* to = out.data() + problem.offset[i];
    for (int r = 0; r < n; ++r) to[r] -= problem.time_step * tree.damping[r] * v[r];
    add_momentum(mass, -1, v, n, to);
    const double* inverse = problem.inverse_mass.data() + problem.offset[i];
    for (int r = 0; r < n; ++r) worst = std::max(worst, std::abs(to[r]) * inverse[r]);
  }
  return worst;
}

bool is_momentum_balanced(const Problem& problem, std::span<const double> residual, double share,
                          double least, std::vector<double>& impulse_sum) {
  impulse_sum.assign(problem.momentum.size(), 0.0);
  const auto add_side = [&](const Constraint& constraint, int index, int first,
                            std::span<const int> dofs) {
    for (std::size_t e = 0; index >= 0 && e < dofs.size(); ++e) {
      double& sum = impulse_sum[problem.offset[index] + dofs[e]];
      for (int r = 0; r < constraint.rows; ++r)
        sum += std::abs(problem.jacobian[first + r * dofs.size() + e] * constraint.impulse[r]);
    }
  };
  for (const Constraint& constraint : problem.constraints) {
    if (!has_impulse(constraint)) continue;
    add_side(constraint, constraint.a, constraint.jacobian_a, constraint.dofs_a);
    add_side(constraint, constraint.b, constraint.jacobian_b, constraint.dofs_b);
  }
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    const int n = problem.trees[i]->dofs;
    for (int k = 0; k < n; ++k) {
      const int index = problem.offset[i] + k;
      const double enough = share * (impulse_sum[index] + std::abs(problem.momentum[index])) +
                            least * problem.mass_of(i)[k * n + k];
      if (std::abs(residual[index]) > enough) return false;
    }
  }
  return true;
}

namespace {

/// Sets impulses by the regularised law.
/// @param linear  out: its linearisations; may be null
void regularise(Problem& problem, std::span<const std::array<double, Constraint::most_rows>> speeds,
                double regularisation, bool about_multipliers, LinearisedLaw* linear) {
  for (std::size_t k = 0; k < problem.constraints.size(); ++k) {
    Constraint& constraint = problem.constraints[k];
    regularise(constraint, speeds[k].data(), regularisation, about_multipliers,
               constraint.impulse.data(), linear ? linear + k : nullptr);
  }
}

/// Squared momentum residual, over the masses [J].
double square(const Problem& problem, const std::vector<double>& missing) {
  double sum = 0;
  for (std::size_t i = 0; i < missing.size(); ++i) {
    sum += missing[i] * missing[i] * problem.inverse_mass[i];
  }
  return sum;
}

}  // namespace

/// One step, about the multipliers or about zero. Constraint velocities must be valid, and are
/// updated.
/// @param shortest    step length; below 1 with a line search on the momentum residual
/// @param unbalanced  out: the largest residual velocity of a coordinate
/// @return            false if no step length reduces the residual
bool VelocitySolver::augmented_lagrangian_step(Problem& problem, double regularisation,
                                               bool about_multipliers, double shortest,
                                               double& unbalanced) {
  constexpr double enough = 0.1;
  assemble_mass(problem, matrix_);
  regularise(problem, constraint_velocities_, regularisation, about_multipliers, laws_.data());
  for (std::size_t k = 0; k < problem.constraints.size(); ++k) {
    add_constraint_hessian(problem, problem.constraints[k], laws_[k], hessian_jacobian_, matrix_);
  }
  unbalanced = momentum_residual(problem, residual_);
  const double before = square(problem, residual_);
  if (before == 0) return true;
  direction_ = residual_;
  if (!matrix_.factor()) return false;
  matrix_.solve(direction_.data());
  kept_velocity_ = problem.velocity;
  for (double step_length = 1; step_length >= shortest; step_length /= 2) {
    for (std::size_t k = 0; k < direction_.size(); ++k) {
      problem.velocity[k] = kept_velocity_[k] + step_length * direction_[k];
    }
    compute_constraint_velocities(problem);
    regularise(problem, constraint_velocities_, regularisation, about_multipliers, nullptr);
    unbalanced = momentum_residual(problem, residual_);
    if (shortest == 1) return true;
    if (square(problem, residual_) < (1 - enough * step_length) * before) return true;
  }
  return false;
}

/// Full steps as long as the residual falls.
/// @return  whether it became small; otherwise the problem holds the best iterate
bool VelocitySolver::augmented_lagrangian(Problem& problem, SolverResult& outcome) {
  double scale = 0, unbalanced = 0;
  compute_constraint_velocities(problem);
  double before = std::max(current_residual(problem, scale), momentum_residual(problem, residual_));
  best_.save(problem);
  double best = before;
  for (Constraint& constraint : problem.constraints) constraint.multiplier = constraint.impulse;
  bool enough = false;
  for (int i = 0; i < options.most_augmented_lagrangian_steps; ++i) {
    ++outcome.augmented_lagrangian_steps;
    if (!augmented_lagrangian_step(problem, options.regularisation, true, 1, unbalanced)) break;
    const double law = current_residual(problem, scale), now = std::max(law, unbalanced);
    if (!(now < HUGE_VAL)) break;
    if (now < best) {
      best = now;
      best_.save(problem);
    }
    if (now <= options.tolerance(scale)) return outcome.residual = now, true;
    enough = best <= options.tolerance_of_regularised(initial_, scale);
    if (i > 0 && now > 0.3 * before) break;
    before = now;
    if (unbalanced <= 0.1 * law) {
      for (Constraint& constraint : problem.constraints) constraint.multiplier = constraint.impulse;
    }
  }
  best_.restore(problem);
  outcome.residual = best;
  return enough;
}

/// Damped steps of the augmented Lagrangian. The regularisation falls where few steps per
/// multiplier are enough, and rises where many are not. Impacts need not be as exact as bodies at
/// rest, which must not creep.
/// @return  whether the residual became small; otherwise the problem holds the best iterate
bool VelocitySolver::damped_augmented_lagrangian(Problem& problem, SolverResult& outcome) {
  constexpr int few = 5, many = 15;
  constexpr double hardest = 1e-7, softest = 1, shortest = 1e-4;
  double scale = 0, unbalanced = 0, regularisation = options.regularisation;
  compute_constraint_velocities(problem);
  double best = std::max(current_residual(problem, scale), momentum_residual(problem, residual_));
  double at_anchor = HUGE_VAL;
  best_.save(problem);
  multiplier_velocity_ = problem.velocity;
  for (Constraint& constraint : problem.constraints) constraint.multiplier = constraint.impulse;
  bool enough = false;
  for (int i = 0, steps = 1; i < options.most_damped_steps; ++i, ++steps) {
    ++outcome.augmented_lagrangian_steps;
    const bool nearer =
        augmented_lagrangian_step(problem, regularisation, true, shortest, unbalanced);
    const double law = current_residual(problem, scale), now = std::max(law, unbalanced);
    if (nearer && now < best) {
      best = now;
      best_.save(problem);
    }
    if (nearer && now <= options.tolerance(scale)) return outcome.residual = now, true;
    enough = best <= options.tolerance_of_regularised(initial_, scale);
    if (enough && initial_.has_impact()) break;
    if (!nearer || steps > many) {
      if (enough || regularisation >= softest) break;
      regularisation *= 10, steps = 0;
      problem.velocity = multiplier_velocity_;
      compute_constraint_velocities(problem);
    } else if (unbalanced <= 0.1 * law) {
      if (enough && law > 0.3 * at_anchor) break;  // no nearer
      at_anchor = law;
      for (Constraint& constraint : problem.constraints) constraint.multiplier = constraint.impulse;
      multiplier_velocity_ = problem.velocity;
      if (steps <= few) regularisation = std::max(hardest, regularisation / 10);
      steps = 0;
    }
  }
  best_.restore(problem);
  outcome.residual = best;
  return enough;
}

/// Continuation: the regularised problem without multipliers, with falling regularisation, so
/// friction is viscous until it slides. Without it contacts that slide slowly, as the two ends of a
/// wheel's line, alternate between sticking and sliding.
void VelocitySolver::continuation(Problem& problem, SolverResult& outcome) {
  constexpr double softest = 1, hardest = 1e-5, shortest = 1e-3, balanced = 1e-2;
  constexpr int most = 10;
  compute_constraint_velocities(problem);
  for (double regularisation = softest; regularisation > 0.9 * hardest; regularisation /= 3) {
    for (int i = 0; i < most; ++i) {
      double unbalanced = 0, scale = 0;
      ++outcome.augmented_lagrangian_steps;
      if (!augmented_lagrangian_step(problem, regularisation, false, shortest, unbalanced)) break;
      current_residual(problem, scale);
      if (unbalanced <= balanced * scale) break;
    }
  }
}

}  // namespace ziggurat::dynamics
