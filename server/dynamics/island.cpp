// One island in a substep: free motion, or motion by the solution of its problem.

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "dynamics/equations.h"
#include "dynamics/energy_error.h"
#include "dynamics/free_motion.h"
#include "dynamics/gyroscopic_stiffness.h"
#include "dynamics/system.h"

namespace ziggurat::dynamics {
namespace {

bool has_free_base(const Tree& tree) {
  return tree.links[0].joint == JointType::floating && tree.freedoms == all_freedoms;
}

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Angular momentum about the tree's origin and linear momentum, of a floating tree.
/// @param mass  its matrix
Vector6 momentum(const Tree& tree, const double* mass) {
  Vector6 out = Vector6::Zero();
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < tree.dofs; ++k) out[i] += mass[i * tree.dofs + k] * tree.v[k];
  }
  return out;
}

/// Centre of mass of a floating tree, from its origin [m].
/// @param mass  its matrix
Vector3 centre_of_mass(const Tree& tree, const double* mass) {
  const int n = tree.dofs;
  return Vector3(mass[2 * n + 4], mass[0 * n + 5], mass[1 * n + 3]) / mass[3 * n + 3];
}

/// Restores the momentum about the centre of mass of a tree after its displacement: the root's
/// velocity changes with the shape. About another point it would be wrong, because a struck body
/// did not move along its velocity.
/// @param mass  its matrix before;  @param drift  see predict_momentum()
void restore_momentum(Tree& tree, Workspace& work, const double* mass, std::span<const double, 6> drift) {
  Vector6 before = momentum(tree, mass);
  for (int i = 0; i < 6; ++i) before[i] += drift[i];
  compute_mass_matrix(tree, work);
  const Vector3 moved = centre_of_mass(tree, work.mass.data()) - centre_of_mass(tree, mass);  // from the origin
  before.head<3>() += moved.cross(Vector3(before.tail<3>()));
  const Vector6 missing = before - momentum(tree, work.mass.data());
  Matrix6 root;
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) root(i, k) = work.mass[i * tree.dofs + k];
  }
  const Vector6 change = root.llt().solve(missing);
  for (int i = 0; i < 6; ++i) tree.v[i] += change[i];
  velocity_kinematics(tree);
}

void add(const SolverResult& outcome, Report& report) {
  ++report.islands;
  report.not_converged += !outcome.converged;
  report.most_iterations = std::max(report.most_iterations, outcome.iterations);
  report.most_augmented_lagrangian_steps = std::max(report.most_augmented_lagrangian_steps, outcome.augmented_lagrangian_steps);
  report.most_interior_point_steps = std::max(report.most_interior_point_steps, outcome.interior_point_steps);
  report.most_passes = std::max(report.most_passes, outcome.passes);
  report.residual = std::max(report.residual, outcome.residual);
}

/// Saves positions and velocities of an island's trees.
void save_states(const std::vector<Tree>& trees, std::span<const int> island, std::vector<double>& out) {
  out.clear();
  for (const int number : island) {
    out.insert(out.end(), trees[number].q.begin(), trees[number].q.end());
    out.insert(out.end(), trees[number].v.begin(), trees[number].v.end());
  }
}

/// Gives them back.
void restore_states(std::vector<Tree>& trees, std::span<const int> island, const std::vector<double>& kept) {
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

/// Displaces a tree of the island. Without friction of the world it keeps its momentum, and so does
/// a tree that would gain energy.
void displace_tree(const Problem& problem, std::size_t i, std::span<const double> by, bool drifts,
              const IslandEnergyErrors& excesses, Workspace& work) {
  Tree& tree = *problem.trees[i];
  integrate_positions(tree, by);
  forward_kinematics(tree);
  velocity_kinematics(tree);
  const EnergyError& excess = excesses.of_trees[i];
  const bool gains = excess.kind != EnergyError::Kind::none && !excess.of_free_joints &&
                     exceeds_rounding(tree, excess.before_kinetic + kinetic_energy(tree));
  if (has_free_base(tree) && (drifts || gains)) {
    restore_momentum(tree, work, problem.mass_of(i), problem.root_bias_impulse[i]);
  }
  if (excess.kind == EnergyError::Kind::none) return;
  correct_energy(tree, work, excess, std::span(excesses.held).subspan(problem.offset[i], tree.dofs),
              !drifts);
}

/// Displaces a tree in free motion out of a penetration. A single body is not rotated, so that its
/// momenta and its energy stay.
void displace_unconstrained(Tree& tree, std::span<const double> by) {
  if (tree.is_single_body && has_free_base(tree)) {
    integrate_positions(tree, std::array{0.0, 0.0, 0.0, by[3], by[4], by[5]});
  } else {
    integrate_positions(tree, by);
  }
  forward_kinematics(tree);
  velocity_kinematics(tree);
}

/// Writes the impulses of contacts, servos and limits, in world axes.
void write_impulses(const Problem& problem, std::span<ContactPoint> contacts, std::span<Servo> servos, std::span<Limit> limits) {
  for (const Constraint& constraint : problem.constraints) {
    const auto& g = constraint.impulse;
    switch (constraint.kind) {
      case Constraint::Kind::contact: {
        ContactPoint& contact = contacts[constraint.source];
        contact.impulse = constraint.frame * Vector3(g[0], g[1], g[2]);
        contact.angular_impulse = constraint.frame * Vector3(g[3], g[4], g[5]);
        break;
      }
      case Constraint::Kind::servo:
        servos[constraint.source].impulse = g[0];
        break;
      case Constraint::Kind::limit:  // along the joint at the lower bound, against it at the upper
        limits[constraint.source].impulse = problem.jacobian[constraint.jacobian_a + constraint.dofs_a[0]] * g[0];
        break;
    }
  }
}

/// Applies the velocities of a solution, and computes displacements; unconstrained trees have moved
/// already.
void apply_velocities(const Problem& problem, const std::vector<unsigned char>& free, std::vector<double>& step) {
  step.resize(problem.velocity.size());
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    Tree& tree = *problem.trees[i];
    for (int k = 0; k < tree.dofs; ++k) {
      const double speed = problem.velocity[problem.offset[i] + k];
      step[problem.offset[i] + k] = free[i] ? 0 : problem.time_step * speed;
      if (!free[i]) tree.v[k] = speed;
    }
  }
}

/// Whether the island has friction with the world.
bool has_world_friction(const Problem& problem) {
  return std::ranges::any_of(problem.constraints, [](const Constraint& b) {
    return b.kind == Constraint::Kind::contact && (b.a < 0 || b.b < 0) && b.friction[0] > 0;
  });
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
    return b.kind == Constraint::Kind::servo && b.is_unsaturated() && std::abs(b.target_velocity[0]) > rounding;
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
void integrate_and_report(Tree& tree, int index, Workspace& work, double time_step, const PrescribedJoints& drive, Report& report) {
  const int steps = integrate_free_motion(tree, work, time_step, drive);
  const int evaluations = tree.is_single_body ? 0 : evaluations_per_step * steps;
  if (evaluations <= report.most_evaluations) return;
  report.most_evaluations = evaluations;
  report.most_evaluated_tree = index;
}

}  // namespace

/// Whether a joint of the island, or of a tree of it, is beyond a limit.
/// @param of  the tree; -1: all
bool System::violates_limit(int first_item, int last_item, int of) const {
  return std::any_of(item_order_.begin() + first_item, item_order_.begin() + last_item, [&](const IslandItem& item) {
    if (item.kind != limit_item) return false;
    const Limit& limit = limits_[item.index];
    if (of >= 0 && limit.tree != of) return false;
    const Tree& tree = trees[limit.tree];
    const double q = tree.q[tree.first_position[limit.link]];
    return q < limit.lower || q > limit.upper;
  });
}

/// Integrates an island without active constraint.
/// @return  whether it moved freely, and stayed within all limits
bool System::integrate_free_island(int first_tree, int last_tree, int first_item, int last_item) {
  for (int i = first_item; i < last_item; ++i) {
    if (item_order_[i].kind != limit_item) return false;
  }
  if (violates_limit(first_item, last_item)) return false;
  const auto island = std::span(tree_order_).subspan(first_tree, last_tree - first_tree);
  if (first_item < last_item) save_states(trees, island, saved_state_);
  for (const int tree : island) integrate_and_report(trees[tree], tree, work_, time_step_, {}, report_);
  if (violates_limit(first_item, last_item)) {
    restore_states(trees, island, saved_state_);
    return false;
  }
  for (int i = first_item; i < last_item; ++i) limits_[item_order_[i].index].impulse = 0;
  return true;
}

/// Assembles the problem of the trees and items of one island.
void System::assemble_problem(int first_tree, int last_tree, int first_item, int last_item) {
  problem_.clear();
  problem_.time_step = time_step_;
  problem_.allowed_overlap = allowed_overlap;
  problem_.compliance_factor = compliance_factor;
  problem_.has_several_trees = last_tree - first_tree > 1;
  has_servos_.assign(last_tree - first_tree, 0);
  for (int i = first_item; i < last_item; ++i) {
    const auto& [island, kind, index] = item_order_[i];
    if (kind == servo_item && is_unsaturated(servos_[index])) has_servos_[index_in_island_[servos_[index].tree]] = 1;
  }
  for (int i = first_tree; i < last_tree; ++i) {
    problem_.add(trees[tree_order_[i]], work_, has_servos_[i - first_tree]);
  }
  const auto index_in_island = [&](int tree) {
    return tree >= 0 && trees[tree].dofs > 0 ? index_in_island_[tree] : -1;
  };
  for (int i = first_item; i < last_item; ++i) {
    const auto [island, kind, index] = item_order_[i];
    if (kind == contact_item) {
      problem_.add(contacts_[index], index_in_island(contacts_[index].a.tree), index_in_island(contacts_[index].b.tree),
                   index);
    } else if (kind == servo_item) {
      problem_.add(servos_[index], index_in_island(servos_[index].tree), index);
    } else {
      problem_.add(limits_[index], index_in_island(limits_[index].tree), index);
    }
  }
}

/// Integrates the unconstrained trees of an island, as far as they stay within their limits; the
/// others become constrained.
/// @return  whether all did
bool System::integrate_free_trees(int first_tree, int last_tree, int first_item, int last_item) {
  find_prescribed_joints(problem_, servos_, prescribed_joints_);
  bool all = true;
  for (int i = 0; i < last_tree - first_tree; ++i) {
    const std::span<const int> tree(&tree_order_[first_tree + i], 1);
    if (is_free_[i]) {
      save_states(trees, tree, saved_state_);
      integrate_and_report(trees[tree[0]], tree[0], work_, time_step_,
                           prescribed_joints_of(problem_, i, prescribed_joints_), report_);
      is_free_[i] = !violates_limit(first_item, last_item, tree[0]);
      if (!is_free_[i]) restore_states(trees, tree, saved_state_);
    }
    all &= is_free_[i];
  }
  return all;
}

void System::apply_impacts(std::span<ContactPoint> contacts, std::span<Servo> servos, std::span<Limit> limits,
                           std::span<const int> chosen) {
  constexpr double instant = 1e-14;  // in which neither forces nor damping change a velocity [s]
  contacts_ = contacts;
  list_contact_trees(contacts_, contact_trees_);
  servos_ = servos;
  limits_ = limits;
  active_ = chosen;
  time_step_ = instant;
  list_awake();
  build_islands();
  for (std::size_t i = 0; i + 1 < first_tree_.size(); ++i) {
    const int first = first_item_[i], last = first_item_[i + 1];
    if (first == last || item_order_[first].kind != contact_item) continue;
    assemble_problem(first_tree_[i], first_tree_[i + 1], first, last);
    if (!apply_impact_law(problem_, solver_, impact_memory_)) continue;
    write_impulses(problem_, contacts_, servos_, limits_);
    for (std::size_t k = 0; k < problem_.trees.size(); ++k) {
      Tree& tree = *problem_.trees[k];
      std::copy_n(problem_.velocity.begin() + problem_.offset[k], tree.dofs, tree.v.begin());
      velocity_kinematics(tree);
    }
  }
  active_ = {};
}

void System::solve_island(int first_tree, int last_tree, int first_item, int last_item) {
  const auto island = std::span(tree_order_).subspan(first_tree, last_tree - first_tree);
  assemble_problem(first_tree, last_tree, first_item, last_item);
  if (impact_mode != ImpactMode::inelastic) {
    const double time = find_first_impact(problem_, solver_, impact_memory_);
    if (impact_mode == ImpactMode::end_step && time < time_step_) {
      for (const int tree : island) wake_flags_[tree] |= WakeFlag::subdivided;
      return islands_to_subdivide.add(island, 0, time);
    }
  }
  const SolverResult outcome = solve_velocities(problem_, solver_);
  const std::size_t free = find_unconstrained(problem_, servos_, work_, free_velocities_, is_free_);
  const bool touched = free < is_free_.size();
  if (most_parts > 1) {
    const int parts = std::max({touched ? parts_for_geometric_stiffness(problem_, contacts_, work_, geometric_stiffness_) : 1, parts_for_gyroscopic_stiffness(problem_, work_),
                                parts_for_rotation(rotations_until_impact, island)});
    if (parts > 1) {
      for (const int tree : island) wake_flags_[tree] |= WakeFlag::subdivided;
      report_.not_converged += parts > most_parts;
      return islands_to_subdivide.add(island, std::min(parts, most_parts));
    }
  }
  add(outcome, report_);
  if (free > 0) clear_contact_impulses(problem_, is_free_);
  write_impulses(problem_, contacts_, servos_, limits_);
  if (free > 0 && integrate_free_trees(first_tree, last_tree, first_item, last_item) && !problem_.leaves_trees_penetrating()) return update_sleep(first_tree, last_tree, false);
  compute_energy_errors(problem_, work_, energy_errors_);
  apply_velocities(problem_, is_free_, displacement_);
  const bool grounded = has_world_friction(problem_), rests = is_supported_by_world(problem_) && !has_moving_motors(problem_);
  if (problem_.become_displacement()) {
    solver_.solve_displacement(problem_);
    for (std::size_t i = 0; i < displacement_.size(); ++i) displacement_[i] += problem_.velocity[i];
    add_lift_energy(problem_, work_, energy_errors_);
  }
  for (std::size_t i = 0; i < problem_.trees.size(); ++i) {
    const std::span<const double> by(displacement_.data() + problem_.offset[i], problem_.trees[i]->dofs);
    if (!is_free_[i]) {
      displace_tree(problem_, i, by, !grounded, energy_errors_, work_);
    } else if (std::ranges::any_of(by, [](double way) { return way != 0; })) {  // another body penetrates it
      displace_unconstrained(*problem_.trees[i], by);
    }
  }
  const bool is_heap = outcome.passes > 0 && outcome.augmented_lagrangian_steps == 0;
  update_sleep(first_tree, last_tree, rests, is_heap ? outcome.residual : 0);
}

}  // namespace ziggurat::dynamics
