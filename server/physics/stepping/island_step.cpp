// SPDX-License-Identifier: MIT
// Step of an island: its stages in order.

#include "physics/stepping/island_step.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "physics/multibody/equations.h"
#include "physics/multibody/free_motion.h"
#include "physics/stepping/correction.h"
#include "physics/stepping/geometric_stiffness.h"

namespace ziggurat::dynamics {
namespace {

void add(const SolverResult& outcome, Report& report) {
  add({.islands = 1,
       .not_converged = outcome.converged ? 0 : 1,
       .most_iterations = outcome.iterations,
       .most_augmented_lagrangian_steps = outcome.augmented_lagrangian_steps,
       .most_interior_point_steps = outcome.interior_point_steps,
       .most_passes = outcome.passes,
       .residual = outcome.residual},
      report);
}

/// Saves positions and velocities of an island's trees.
void save_states(const std::vector<Tree>& trees, std::span<const int> island,
                 std::vector<double>& out) {
  out.clear();
  for (const int number : island) {
    out.insert(out.end(), trees[number].q.begin(), trees[number].q.end());
    out.insert(out.end(), trees[number].v.begin(), trees[number].v.end());
  }
}

/// Gives them back.
void restore_states(std::vector<Tree>& trees, std::span<const int> island,
                    const std::vector<double>& kept) {
  const double* next = kept.data();
  for (const int number : island) {
    Tree& tree = trees[number];
    std::copy_n(next, tree.q.size(), tree.q.begin());
    std::copy_n(next + tree.q.size(), tree.v.size(), tree.v.begin());
    next += tree.q.size() + tree.v.size();
    forward_kinematics(tree);
    velocity_kinematics(tree);
  }
}

/// Displaces a tree; its velocities stay.
void displace_tree(Tree& tree, std::span<const double> by) {
  integrate_positions(tree, by);
  forward_kinematics(tree);
  velocity_kinematics(tree);
}

/// Displaces a tree in free motion out of a penetration. A single body is not rotated, so that its
/// momenta and its energy stay.
void displace_unconstrained(Tree& tree, std::span<const double> by) {
  const bool rotates = !tree.is_single_body || tree.links[0].joint != JointType::floating ||
                       tree.freedoms != all_freedoms;
  displace_tree(tree, rotates ? by : std::array{0.0, 0.0, 0.0, by[3], by[4], by[5]});
}

/// Sets the velocities of a solution, and computes displacements; unconstrained trees have moved
/// already.
void set_velocities(const Problem& problem, std::span<const unsigned char> is_free,
                    std::vector<double>& displacement) {
  displacement.resize(problem.velocity.size());
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    Tree& tree = *problem.trees[i];
    for (int k = 0; k < tree.dofs; ++k) {
      const double speed = problem.velocity[problem.offset[i] + k];
      displacement[problem.offset[i] + k] = is_free[i] ? 0 : problem.time_step * speed;
      if (!is_free[i]) tree.v[k] = speed;
    }
  }
}

/// Whether a contact with the world supports the island.
bool is_supported_by_world(const Problem& problem) {
  return std::ranges::any_of(problem.constraints, [](const Constraint& b) {
    return b.kind == Constraint::Kind::contact && (b.a < 0 || b.b < 0) && b.impulse[0] > 0;
  });
}

/// Whether a servo within its bounds moves something, however slowly.
bool has_moving_motors(const Problem& problem) {
  constexpr double rounding = 1e-7;  // of a servo that holds still [m/s], [rad/s]
  return std::ranges::any_of(problem.constraints, [](const Constraint& b) {
    return b.kind == Constraint::Kind::servo && b.is_unsaturated() &&
           std::abs(b.target_velocity[0]) > rounding;
  });
}

/// Number of parts into which an island divides its step for links that rotate until impact.
int parts_for_rotation(std::span<const RotationUntilImpact> swings, std::span<const int> island) {
  constexpr double most = 0.1;  // in a part [rad]
  double angle = 0;
  for (const RotationUntilImpact& swing : swings) {
    if (std::ranges::find(island, swing.tree) != island.end()) angle = std::max(angle, swing.angle);
  }
  return static_cast<int>(std::ceil(std::min(angle / most, 1e6)));
}

/// Integrates a tree in free motion, and reports how often its equations of motion were evaluated.
void integrate_and_report(Tree& tree, int index, Workspace& work, double time_step,
                          const PrescribedJoints& drive, Report& report) {
  const int steps = integrate_free_motion(tree, work, time_step, drive);
  const int evaluations = tree.is_single_body ? 0 : evaluations_per_step * steps;
  if (evaluations <= report.most_evaluations) return;
  report.most_evaluations = evaluations;
  report.most_evaluated_tree = index;
}

/// Whether a joint of the island, or of a tree of it, is beyond a limit.
/// @param of  the tree; -1: all
bool violates_limit(const IslandStep& step, int of = -1) {
  return std::ranges::any_of(step.island.items, [&](const IslandItem& item) {
    if (item.kind != IslandItem::Kind::limit) return false;
    const Limit& limit = step.constraints.limits[item.index];
    if (of >= 0 && limit.tree != of) return false;
    const Tree& tree = step.trees[limit.tree];
    const double q = tree.q[tree.first_position[limit.link]];
    return q < limit.lower || q > limit.upper;
  });
}

/// Integrates an island without active constraint.
/// @return  whether it moved freely, and stayed within all limits
bool integrate_free_island(const IslandStep& step) {
  const auto is_limit = [](const IslandItem& item) { return item.kind == IslandItem::Kind::limit; };
  if (!std::ranges::all_of(step.island.items, is_limit) || violates_limit(step)) return false;
  enter(step.watch, timing::Phase::integrate);
  IslandMemory& memory = step.memory;
  if (!step.island.items.empty()) save_states(step.trees, step.island.trees, memory.saved_state);
  for (const int tree : step.island.trees)
    integrate_and_report(step.trees[tree], tree, memory.work, step.time_step, {}, step.report);
  if (violates_limit(step)) {
    restore_states(step.trees, step.island.trees, memory.saved_state);
    return false;
  }
  for (const IslandItem& item : step.island.items) step.constraints.limits[item.index].impulse = 0;
  return true;
}

/// Integrates the unconstrained trees of an island, as far as they stay within their limits; the
/// others become constrained.
/// @return  whether all did
bool integrate_free_trees(const IslandStep& step) {
  IslandMemory& memory = step.memory;
  find_prescribed_joints(memory.problem, step.constraints.servos, memory.prescribed_joints);
  bool all = true;
  for (std::size_t i = 0; i < step.island.trees.size(); ++i) {
    const std::span<const int> tree = step.island.trees.subspan(i, 1);
    if (memory.is_free[i]) {
      save_states(step.trees, tree, memory.saved_state);
      integrate_and_report(step.trees[tree[0]], tree[0], memory.work, step.time_step,
                           prescribed_joints_of(memory.problem, i, memory.prescribed_joints),
                           step.report);
      memory.is_free[i] = !violates_limit(step, tree[0]);
      if (!memory.is_free[i]) restore_states(step.trees, tree, memory.saved_state);
    }
    all &= memory.is_free[i];
  }
  return all;
}

/// Number of parts that a solved island asks for: impulses act along lines of the step's beginning.
int count_parts(const IslandStep& step, bool is_touched) {
  if (step.options.most_parts <= 1) return 1;
  IslandMemory& memory = step.memory;
  return std::max({is_touched
                       ? parts_for_geometric_stiffness(memory.problem, step.constraints.contacts,
                                                       memory.work, memory.geometric_stiffness)
                       : 1,
                   parts_for_gyroscopic_stiffness(memory.problem, memory.work),
                   parts_for_rotation(step.rotations_until_impact, step.island.trees)});
}

/// Integrates the positions of constrained trees, and displaces unconstrained ones out of
/// penetrations.
void integrate_island(const IslandStep& step) {
  const Problem& problem = step.memory.problem;
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    const std::span<const double> by(step.memory.displacement.data() + problem.offset[i],
                                     problem.trees[i]->dofs);
    if (!step.memory.is_free[i]) {
      displace_tree(*problem.trees[i], by);
    } else if (std::ranges::any_of(by, [](double way) { return way != 0; })) {
      displace_unconstrained(*problem.trees[i], by);
    }
  }
}

}  // namespace

void add(const Report& island, Report& all) {
  all.islands += island.islands;
  all.not_converged += island.not_converged;
  all.most_iterations = std::max(all.most_iterations, island.most_iterations);
  all.most_augmented_lagrangian_steps =
      std::max(all.most_augmented_lagrangian_steps, island.most_augmented_lagrangian_steps);
  all.most_interior_point_steps =
      std::max(all.most_interior_point_steps, island.most_interior_point_steps);
  all.most_passes = std::max(all.most_passes, island.most_passes);
  all.residual = std::max(all.residual, island.residual);
  if (island.most_evaluations <= all.most_evaluations) return;
  all.most_evaluations = island.most_evaluations;
  all.most_evaluated_tree = island.most_evaluated_tree;
}

void assemble_problem(const IslandStep& step) {
  IslandMemory& memory = step.memory;
  Problem& problem = memory.problem;
  const ConstraintLists& constraints = step.constraints;
  const auto& index_in_island = step.islands.index_in_island;
  problem.clear();
  problem.time_step = step.time_step;
  problem.allowed_overlap = step.options.allowed_overlap;
  problem.compliance_factor = step.options.compliance_factor;
  problem.has_several_trees = step.island.trees.size() > 1;
  memory.has_servos.assign(step.island.trees.size(), 0);
  for (const IslandItem& item : step.island.items) {
    if (item.kind != IslandItem::Kind::servo) continue;
    const Servo& servo = constraints.servos[item.index];
    if (servo.other.tree < 0 && is_unsaturated(servo))
      memory.has_servos[index_in_island[servo.tree]] = 1;
  }
  for (std::size_t i = 0; i < step.island.trees.size(); ++i) {
    problem.add(step.trees[step.island.trees[i]], memory.work, memory.has_servos[i]);
  }
  const auto index_of = [&](int tree) {
    return tree >= 0 && step.trees[tree].dofs > 0 ? index_in_island[tree] : -1;
  };
  for (const auto& [island, kind, index] : step.island.items) {
    switch (kind) {
      case IslandItem::Kind::contact: {
        const ContactPoint& contact = constraints.contacts[index];
        problem.add(contact, index_of(contact.a.tree), index_of(contact.b.tree), index);
        break;
      }
      case IslandItem::Kind::servo:
        problem.add(constraints.servos[index], index_of(constraints.servos[index].tree),
                    index_of(constraints.servos[index].other.tree), index);
        break;
      case IslandItem::Kind::limit:
        problem.add(constraints.limits[index], index_of(constraints.limits[index].tree), index);
        break;
    }
  }
}

void write_impulses(const Problem& problem, const ConstraintLists& constraints) {
  for (const Constraint& constraint : problem.constraints) {
    const auto& g = constraint.impulse;
    switch (constraint.kind) {
      case Constraint::Kind::contact: {
        ContactPoint& contact = constraints.contacts[constraint.source];
        contact.impulse = constraint.frame * Vector3(g[0], g[1], g[2]);
        contact.angular_impulse = constraint.frame * Vector3(g[3], g[4], g[5]);
        break;
      }
      case Constraint::Kind::servo:
        constraints.servos[constraint.source].impulse = g[0];
        break;
      case Constraint::Kind::limit:  // along the joint at the lower bound, against it at the upper
        constraints.limits[constraint.source].impulse =
            problem.jacobian[constraint.jacobian_a] * g[0];
        break;
    }
  }
}

IslandOutcome step_island(const IslandStep& step) {
  if (integrate_free_island(step)) return {};
  enter(step.watch, timing::Phase::solve);
  IslandMemory& memory = step.memory;
  Problem& problem = memory.problem;
  assemble_problem(step);
  if (step.options.impact_mode != ImpactMode::inelastic) {
    const double time = find_first_impact(problem, memory.solver, memory.impact);
    if (step.options.impact_mode == ImpactMode::end_step && time < step.time_step)
      return {.parts = 0, .impact_time = time};
  }
  turn_start(problem);
  const SolverResult solution = solve_velocities(problem, memory.solver);
  const std::size_t free = find_unconstrained(problem, step.constraints.servos, memory.work,
                                              memory.free_velocities, memory.is_free);
  if (const int parts = count_parts(step, free < memory.is_free.size()); parts > 1) {
    step.report.not_converged += parts > step.options.most_parts;
    return {.parts = std::min(parts, step.options.most_parts)};
  }
  add(solution, step.report);
  if (free > 0) clear_contact_impulses(problem, memory.is_free);
  write_impulses(problem, step.constraints);
  enter(step.watch, timing::Phase::integrate);
  if (free > 0 && integrate_free_trees(step) && !problem.leaves_trees_penetrating()) return {};

  compute_energy_errors(problem, memory.work, memory.energy_errors);
  set_velocities(problem, memory.is_free, memory.displacement);
  IslandOutcome outcome;
  outcome.is_carried = is_supported_by_world(problem) && !has_moving_motors(problem);
  const bool is_heap = solution.passes > 0 && solution.augmented_lagrangian_steps == 0;
  outcome.heap_residual = is_heap ? solution.residual : 0;
  const IslandEnd end{problem, memory.work, memory.energy_errors, memory.is_free,
                      has_world_friction(problem)};  // before the displacement problem
  if (problem.become_displacement()) {
    memory.solver.solve_displacement(problem);
    for (std::size_t i = 0; i < memory.displacement.size(); ++i)
      memory.displacement[i] += problem.velocity[i];
    add_lift_energy(problem, memory.work, memory.energy_errors);
  }
  integrate_island(step);
  correct(end);
  return outcome;
}

void apply_impacts(const IslandStep& step) {
  Problem& problem = step.memory.problem;
  assemble_problem(step);
  if (!apply_impact_law(problem, step.memory.solver, step.memory.impact)) return;
  write_impulses(problem, step.constraints);
  for (std::size_t k = 0; k < problem.trees.size(); ++k) {
    Tree& tree = *problem.trees[k];
    std::copy_n(problem.velocity.begin() + problem.offset[k], tree.dofs, tree.v.begin());
    velocity_kinematics(tree);
  }
}

void separate(const IslandStep& step) {
  Problem& problem = step.memory.problem;
  assemble_problem(step);
  std::ranges::fill(problem.velocity, 0.0);
  for (Constraint& constraint : problem.constraints) constraint.impulse.fill(0);
  if (!problem.become_displacement()) return;
  const double before = energy(problem.trees);
  step.memory.solver.solve_displacement(problem);
  for (std::size_t k = 0; k < problem.trees.size(); ++k) {
    Tree& tree = *problem.trees[k];
    displace_tree(
        tree, {problem.velocity.data() + problem.offset[k], static_cast<std::size_t>(tree.dofs)});
  }
  remove_kinetic_energy(problem.trees, step.memory.work, energy(problem.trees) - before);
}

}  // namespace ziggurat::dynamics
