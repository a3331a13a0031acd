// SPDX-License-Identifier: MIT
// Choice of the methods: which one an island gets, and what follows where it fails.

#include <algorithm>
#include <cmath>

#include "physics/solver/newton.h"

namespace ziggurat::dynamics {

SolverResult VelocitySolver::solve(Problem& problem) {
  SolverResult outcome;
  if (is_warm_start_solved(problem, outcome)) return outcome;
  const double work = analyse(problem);
  const bool suits_newton = options.suits_newton(problem.trees.size(), work);
  if (suits_newton) {
    if (newton(problem, outcome, options.most_stalled_iterations)) return outcome;
    start_.restore(problem);
  } else {
    problem.make_rigid();
  }
  if (problem.trees.size() > options.few_trees || !suits_newton) {
    const bool may_factor = suits_newton || work <= options.most_work(initial_.has_impact());
    const bool suffices = heap_passes(problem, outcome, may_factor);
    if (suffices || !may_factor) return outcome;
  }
  if (suits_newton) {
    continuation(problem, outcome);
    outcome.converged = damped_augmented_lagrangian(problem, outcome);
    if (!outcome.converged) {
      start_.restore(problem);
      augmented_lagrangian_after_gauss_seidel(problem, outcome);
    }
    if (outcome.converged) {
      polish(problem, outcome);
      return outcome;
    }
    start_.restore(problem);
    problem.make_rigid();
  } else if (augmented_lagrangian(problem, outcome)) {
    return outcome;
  }
  start_.restore(problem);
  const bool found = interior_point(problem, outcome);
  outcome.converged = augmented_lagrangian(problem, outcome);
  if (outcome.converged && found) return outcome;
  const SolverResult before = outcome;  // large impulses of redundant contacts hide a residual
  start_.save(problem);
  augmented_lagrangian_after_gauss_seidel(problem, outcome);
  if (outcome.residual > before.residual) {
    start_.restore(problem);
    outcome.residual = before.residual;
    outcome.converged = before.converged;
  }
  return outcome;
}

/// Solves a heap by passes. While it moves, they end as soon as one changes little beside the
/// motion: its solution is gone in the next substep. As it comes to rest, its motion vanishes, and
/// errors would be seen as creeping.
/// @param may_factor  another method can follow; then a heap almost at rest is left to it
/// @return            whether they suffice; otherwise, if another method follows, nothing changed
bool VelocitySolver::heap_passes(Problem& problem, SolverResult& outcome, bool may_factor) {
  const bool moves = initial_.fastest_contact >= options.moving_speed * initial_.gravity_change;
  if (may_factor && !moves) return false;
  if (gauss_seidel(problem, outcome, options.most_passes, moves ? options.moving_change : 0))
    return true;
  if (may_factor) start_.restore(problem);
  return false;
}

/// Passes until one changes little, or until the residual is small.
/// @param change  of the velocities, over them; 0: the residual decides
bool VelocitySolver::gauss_seidel(Problem& problem, SolverResult& outcome, int most,
                                  double change) {
  constexpr int between = 10;  // passes between two evaluations of the residual
  gauss_seidel_.start(problem);
  for (int pass = 1; pass <= most; ++pass) {
    ++outcome.passes;
    gauss_seidel_.pass();
    const bool is_steady = change > 0 && gauss_seidel_.relative_change() <= change;
    const bool is_evaluated = change == 0 && pass % between == 0;
    if (!is_steady && !is_evaluated && pass < most) {
      gauss_seidel_.accelerate();
      continue;
    }
    gauss_seidel_.finish(problem);
    double scale = 0;
    compute_constraint_velocities(problem);
    outcome.residual = current_residual(problem, scale);
    const double tolerance = options.tolerance_of_regularised(initial_, scale);
    outcome.converged = is_steady || outcome.residual <= tolerance;
    if (outcome.converged) return true;
    gauss_seidel_.accelerate();
  }
  return false;
}

/// Polishes a solution of the regularised problem by Newton's method. Its residual exceeds the
/// contacts' compliance, and would share loads at random.
void VelocitySolver::polish(Problem& problem, SolverResult& outcome) {
  const double before = outcome.residual;
  start_.save(problem);
  compute_constraint_velocities(problem);
  if (newton(problem, outcome, options.most_stalled_iterations)) return;
  start_.restore(problem);
  outcome.residual = before;
}

/// Passes, then the augmented Lagrangian from their result. Passes find which contacts hold, stick
/// and slide. Where these conflict, as rolling friction and the two ends of a line do, only the
/// augmented Lagrangian converges.
bool VelocitySolver::augmented_lagrangian_after_gauss_seidel(Problem& problem,
                                                             SolverResult& outcome) {
  gauss_seidel_.start(problem);
  for (int pass = 1; pass <= options.passes_before_augmented_lagrangian; ++pass) {
    gauss_seidel_.pass();
    if (pass < options.passes_before_augmented_lagrangian) gauss_seidel_.accelerate();
  }
  gauss_seidel_.finish(problem);
  outcome.passes += options.passes_before_augmented_lagrangian;
  return outcome.converged = damped_augmented_lagrangian(problem, outcome);
}

namespace {

/// Bounds a displacement of joints to angles for which its linear constraints hold. In a light,
/// long chain impulses below rounding turn links far, and their ends through what they touch.
/// Single bodies turn as far as their overlaps ask.
void bound_rotation(Problem& problem) {
  constexpr double most = 0.02;  // [rad]
  double angle = most;
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    const Tree& tree = *problem.trees[i];
    for (int k = 0; k < tree.dofs && !tree.is_single_body; ++k) {
      if (tree.motion_subspace[k].angular.isZero(0)) continue;
      angle = std::max(angle, std::abs(problem.velocity[problem.offset[i] + k]));
    }
  }
  if (angle == most) return;
  for (double& way : problem.velocity) way *= most / angle;
}

}  // namespace

void VelocitySolver::solve_displacement(Problem& problem) {
  SolverResult outcome;
  compute_constraint_velocities(problem);
  const double work = analyse(problem);
  const bool suits_newton = options.suits_newton(problem.trees.size(), work);
  if (!suits_newton || !newton(problem, outcome, options.most_iterations)) {
    if (suits_newton) start_.restore(problem);
    const bool suffices =
        gauss_seidel(problem, outcome, options.displacement_passes, options.moving_change);
    const bool may_factor = suits_newton || work <= options.most_impact_work;
    if (may_factor && !suffices && outcome.residual > options.displacement_residual)
      damped_augmented_lagrangian(problem, outcome);
  }
  bound_rotation(problem);
}

SolverResult solve_velocities(Problem& problem, VelocitySolver& solver) {
  constexpr int most_switches = 3;
  problem.bound_penetration();
  problem.settle_loads();
  SolverResult outcome = solver.solve(problem);
  for (int i = 0; i < most_switches && problem.switch_limits(); ++i) {
    const int iterations = outcome.iterations;
    outcome = solver.solve(problem);
    outcome.iterations += iterations;
  }
  return outcome;
}

}  // namespace ziggurat::dynamics
