// SPDX-License-Identifier: MIT
#include "physics/stepping/energy_error.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace ziggurat::dynamics {
namespace {

constexpr double far = 0.1;         // [rad] per substep
constexpr double least = 1e-10;     // of the kinetic energy
constexpr double wild = 0.1;        // likewise, of a gain without servos
constexpr double most_given = 0.1;  // of the joints' energy: larger losses are impacts

// Bounds per second of squared angle and squared relative change of velocity [1/s]: a substep's
// relative energy error is about their size. Per second, so that short substeps do not add up to
// more than long ones.
constexpr double near = 1e-3;   // the angle, of what is struck
constexpr double bends = 1e-5;  // relative change by Coriolis forces

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Velocities of the root with which the tree, as a rigid body, has the same momentum and angular
/// momentum.
/// @param energy  then [J]
Vector6 rigid_motion(const Tree& tree, Workspace& work, double& energy) {
  compute_mass_matrix(tree, work);
  Vector6 momentum = Vector6::Zero();
  Matrix6 root;
  for (int i = 0; i < 6; ++i) {
    const double* row = work.mass.data() + i * tree.dofs;
    for (int k = 0; k < tree.dofs; ++k) momentum[i] += row[k] * tree.v[k];
    for (int k = 0; k < 6; ++k) root(i, k) = row[k];
  }
  const Vector6 motion = root.llt().solve(momentum);
  energy = momentum.dot(motion) / 2;
  return motion;
}

Vector3 mean_velocity(const Tree& tree, double& mass) {
  Vector3 momentum = Vector3::Zero();
  mass = 0;
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    mass += tree.links[i].mass;
    momentum += tree.links[i].mass * tree.velocity(static_cast<int>(i));
  }
  return momentum / mass;
}

/// Factor of velocities with this energy that removes the excess.
double velocity_scale(double energy, double excess) {
  return energy > excess ? std::sqrt(1 - excess / energy) : 0;
}

/// Whether links rotate further than an angle within a substep.
/// @param after  solved velocities;  @param angle  [rad]
bool rotates(const Tree& tree, std::span<const double> after, double time_step, double angle) {
  const double most = angle * angle / (time_step * time_step);
  for (int k = 0; k < tree.dofs; ++k) {
    if (tree.motion_subspace[k].angular.squaredNorm() * after[k] * after[k] > most) return true;
  }
  return std::any_of(tree.spatial_velocity.begin(), tree.spatial_velocity.end(),
                     [&](const Motion& motion) { return motion.angular.squaredNorm() > most; });
}

/// Whether contacts and servos change a tree's velocities by much.
/// @param mass  its matrix, dofs x dofs
bool is_struck(const Tree& tree, const double* mass, std::span<const double> after) {
  constexpr double little = 1e-3;  // of the energy, so to speak
  double all = 0, change = 0;
  for (int k = 0; k < tree.dofs; ++k) {
    const double own = mass[k * tree.dofs + k], step = after[k] - tree.v[k];
    all += own * after[k] * after[k];
    change += own * step * step;
  }
  return change > little * all;
}

/// Classifies the error of a tree.
/// @param after  solved velocities
EnergyError::Kind kind_of(const Problem& problem, std::size_t i, std::span<const double> after) {
  const Tree& tree = *problem.trees[i];
  if (rotates(tree, after, problem.time_step, far)) return EnergyError::Kind::large_rotation;
  const double time_step = problem.time_step;
  const bool bent = problem.bias_velocity_change[i] > std::sqrt(bends * time_step) ||
                    (is_struck(tree, problem.mass_of(i), after) &&
                     rotates(tree, after, time_step, std::sqrt(near * time_step)));
  return bent ? EnergyError::Kind::coriolis : EnergyError::Kind::none;
}

/// Impulse of bias forces on a dof, from the momentum that the problem was solved with;
/// work.scratch must have the external forces.
/// @param momentum  of the dof, see predict_momentum();  @param after  its solved velocity
double bias_impulse(const Tree& tree, const Workspace& work, const double* mass, double momentum,
                    double after, double time_step, int dof) {
  double before = 0;
  for (int k = 0; k < tree.dofs; ++k) before += mass[dof * tree.dofs + k] * tree.v[k];
  return momentum - before - time_step * (work.scratch[dof] + tree.damping[dof] * after);
}

/// Energy error, less the tree's final kinetic energy; at its state of the beginning.
/// @param mass      its matrix, dofs x dofs
/// @param momentum  that it was solved with, see predict_momentum()
/// @param after     solved velocities
/// @return          [J]
double error_before_kinetic(const Tree& tree, Workspace& work, const double* mass,
                            std::span<const double> momentum, std::span<const double> after,
                            double time_step) {
  // Bias impulse b = M (after - before) - h (forces) - J^T g. Its work b (before + after) / 2 and
  // the change of after^T M after / 2 with the pose should cancel.
  work.scratch.resize(tree.dofs);
  external_forces(tree, work, work.scratch, true, true);
  double sum = 0;
  for (int i = 0; i < tree.dofs; ++i) {
    double energy = 0;
    for (int k = 0; k < tree.dofs; ++k) energy += mass[i * tree.dofs + k] * after[k] / 2;
    const double of_turning = bias_impulse(tree, work, mass, momentum[i], after[i], time_step, i);
    sum += of_turning * (tree.v[i] + after[i]) / 2 - energy * after[i];
  }
  return sum;
}

bool is_free_joint(const Tree& tree, std::span<const unsigned char> held, int dof) {
  return dof >= tree.dof_count[0] && held[dof] == IslandEnergyErrors::free;
}

bool is_driven(std::span<const unsigned char> held) {
  return std::find(held.begin(), held.end(), IslandEnergyErrors::driven) != held.end();
}

bool has_free_joint(const Tree& tree, std::span<const unsigned char> held) {
  for (int k = 0; k < tree.dofs; ++k) {
    if (is_free_joint(tree, held, k)) return true;
  }
  return false;
}

/// Twice the kinetic energy of free joints while nothing else moves [J].
double square_of_free(const Tree& tree, std::span<const unsigned char> held, const double* mass,
                      std::span<const double> speeds) {
  double sum = 0;
  for (int i = 0; i < tree.dofs; ++i) {
    for (int k = 0; k < tree.dofs && is_free_joint(tree, held, i); ++k) {
      if (is_free_joint(tree, held, k)) sum += speeds[i] * mass[i * tree.dofs + k] * speeds[k];
    }
  }
  return sum;
}

/// Bias forces of a part of a tree's velocities, which stay.
/// @param of_free  of its free joints, or of all others
void bias_of_joints(Tree& tree, Workspace& work, std::span<const unsigned char> held, bool of_free,
                    std::vector<double>& speeds, std::vector<double>& out) {
  speeds.assign(tree.v.begin(), tree.v.end());
  for (int k = 0; k < tree.dofs; ++k) {
    if (is_free_joint(tree, held, k) != of_free) tree.v[k] = 0;
  }
  velocity_kinematics(tree);
  out.resize(tree.dofs);
  bias_forces(tree, work, out);
  std::copy(speeds.begin(), speeds.end(), tree.v.begin());
  velocity_kinematics(tree);
}

/// Energy error of the free joints of a tree with prescribed joints. Servos give all the power that
/// prescribed motion takes. Its centrifugal forces on free joints act as a potential, and are no
/// error. The work of forces that depend on both motions counts by half.
double error_of_free_joints(Tree& tree, Workspace& work, const double* mass,
                            std::span<const double> momentum, std::span<const double> after,
                            double time_step, std::span<const unsigned char> held,
                            IslandEnergyErrors& memory) {
  compute_mass_matrix(tree, work);
  bias_of_joints(tree, work, held, false, memory.velocities, memory.bias_of_held);
  bias_of_joints(tree, work, held, true, memory.velocities, memory.bias_of_free);
  work.scratch.resize(tree.dofs);
  external_forces(tree, work, work.scratch, true, true);
  double sum = -square_of_free(tree, held, mass, after) / 2;
  for (int i = 0; i < tree.dofs; ++i) {
    if (!is_free_joint(tree, held, i)) continue;
    const double own = bias_impulse(tree, work, mass, momentum[i], after[i], time_step, i) +
                       time_step * memory.bias_of_held[i];
    const double of_both = own + time_step * memory.bias_of_free[i];
    sum += own * (tree.v[i] + after[i]) / 2 - of_both * tree.v[i] / 2;
  }
  return sum;
}

/// Potential energy that a displacement adds to a tree.
/// @param by  of each dof [m], [rad]
/// @return    [J], >= 0
double lift_energy(const Tree& tree, Workspace& work, const double* by) {
  work.scratch.resize(tree.dofs);
  external_forces(tree, work, work.scratch, false, true);
  double sum = 0;
  for (int k = 0; k < tree.dofs; ++k) sum -= work.scratch[k] * by[k];
  return std::max(0.0, sum);
}

/// See IslandEnergyErrors.
void list_held_dofs(const Problem& problem, std::vector<unsigned char>& held) {
  static_assert(IslandEnergyErrors::separate == 1, "spins is 0 or 1");
  held.clear();
  for (const Tree* tree : problem.trees)
    held.insert(held.end(), tree->is_symmetric_rotor.begin(), tree->is_symmetric_rotor.end());
  for (const Constraint& constraint : problem.constraints) {
    const bool is_between_trees = constraint.b >= 0;  // contacts and grips
    if (constraint.kind == Constraint::Kind::contact || is_between_trees ||
        !constraint.is_unsaturated())
      continue;
    const bool drives = constraint.kind == Constraint::Kind::servo;
    for (const int k : constraint.dofs_a) {
      unsigned char& dof = held[problem.offset[constraint.a] + k];
      dof = drives ? IslandEnergyErrors::driven : std::max(dof, IslandEnergyErrors::separate);
    }
  }
}

/// Internal motion: velocities of the free joints, with the root velocity that makes the tree's
/// momentum and angular momentum zero.
/// @param of_joints  out: of each dof;  @param momentum  out: that it has, of each dof
void find_internal_motion(const Tree& tree, Workspace& work, std::span<const unsigned char> held,
                          std::vector<double>& of_joints, std::vector<double>& momentum) {
  const int n = tree.dofs, root = tree.dof_count[0];
  compute_mass_matrix(tree, work);
  of_joints.assign(n, 0.0);
  momentum.assign(n, 0.0);
  for (int k = root; k < n; ++k) of_joints[k] = held[k] == IslandEnergyErrors::free ? tree.v[k] : 0;
  const auto add = [&](int from, int to) {
    for (int i = 0; i < n; ++i) {
      for (int k = from; k < to; ++k) momentum[i] += work.mass[i * n + k] * of_joints[k];
    }
  };
  add(root, n);
  if (root == 0) return;
  Matrix6 mass = Matrix6::Identity();
  Vector6 change = Vector6::Zero();
  for (int i = 0; i < root; ++i) {
    change[i] = -momentum[i];
    for (int k = 0; k < root; ++k) mass(i, k) = work.mass[i * n + k];
  }
  change = mass.llt().solve(change);
  std::copy_n(change.data(), root, of_joints.begin());
  add(0, root);
}

/// Removes energy from the free joints, or adds it. Momentum and angular momentum stay if the tree
/// is free.
/// @param excess  [J]; < 0: to be added
/// @return        removed energy [J]
double correct_joint_energy(Tree& tree, Workspace& work, std::span<const unsigned char> held,
                            double excess) {
  if (std::abs(excess) <= least * kinetic_energy(tree)) return 0;
  find_internal_motion(tree, work, held, work.scratch, work.saved_state);
  double slope = 0, curve = 0;  // of the energy, along the internal motion
  for (int k = 0; k < tree.dofs; ++k) {
    slope += work.saved_state[k] * tree.v[k];
    curve += work.saved_state[k] * work.scratch[k] / 2;
  }
  if (slope <= 0 || curve <= 0 || -excess > most_given * curve) return 0;
  const double square = slope * slope - 4 * curve * excess;
  const double way = square > 0 ? -2 * excess / (slope + std::sqrt(square)) : -slope / (2 * curve);
  for (int k = 0; k < tree.dofs; ++k) tree.v[k] += way * work.scratch[k];
  velocity_kinematics(tree);
  return square > 0 ? excess : slope * slope / (4 * curve);
}

/// Removes energy from the free joints of a tree with prescribed joints, or adds it.
/// @param before  see EnergyError
void correct_free_joint_energy(Tree& tree, Workspace& work, std::span<const unsigned char> held,
                               double before) {
  find_internal_motion(tree, work, held, work.scratch, work.saved_state);
  const double all = square_of_free(tree, held, work.mass.data(), tree.v) / 2;
  const double excess = std::clamp(before + all, -most_given * all, most_given * all);
  if (std::abs(excess) <= least * all) return;
  const double more = std::sqrt(1 - excess / all) - 1;
  for (int k = 0; k < tree.dofs; ++k) tree.v[k] += more * work.scratch[k];
  velocity_kinematics(tree);
}

/// Restores a single body's loss of rotational energy.
/// @param excess  [J]; nothing happens where it is a gain
void restore_rotation_energy(Tree& tree, double excess) {
  const Vector3 drift = tree.velocity(0);
  const double turning = kinetic_energy(tree) - tree.links[0].mass * drift.squaredNorm() / 2;
  if (excess >= 0 || -excess > most_given * turning) return;
  const double share = std::sqrt(1 - excess / turning);
  for (int k = 0; k < 3; ++k) tree.v[k] *= share;
  velocity_kinematics(tree);
}

/// Scales all velocities down to an energy: friction may have turned rotation into translation.
/// @param most  kinetic energy [J]
void scale_velocities(Tree& tree, double most) {
  const double all = kinetic_energy(tree);
  if (all <= 0 || all - most <= least * all) return;
  const double share = std::sqrt(std::max(0.0, most) / all);
  for (double& speed : tree.v) speed *= share;
  velocity_kinematics(tree);
}

}  // namespace

void compute_energy_errors(const Problem& problem, Workspace& work, IslandEnergyErrors& out) {
  out.of_trees.assign(problem.trees.size(), {});
  bool any = false;
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    const auto after =
        std::span(problem.velocity).subspan(problem.offset[i], problem.trees[i]->dofs);
    out.of_trees[i].kind = kind_of(problem, i, after);
    any |= out.of_trees[i].kind != EnergyError::Kind::none;
  }
  if (!any) return;
  list_held_dofs(problem, out.held);
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    EnergyError& excess = out.of_trees[i];
    if (excess.kind == EnergyError::Kind::none) continue;
    Tree& tree = *problem.trees[i];
    const std::size_t first = problem.offset[i], dofs = tree.dofs;
    const auto after = std::span(problem.velocity).subspan(first, dofs);
    const auto momentum = std::span(problem.momentum).subspan(first, dofs);
    const auto held = std::span(out.held).subspan(first, dofs);
    excess.of_free_joints = is_driven(held) && has_free_joint(tree, held);
    if (is_driven(held) && !excess.of_free_joints && excess.kind == EnergyError::Kind::coriolis) {
      excess.kind = EnergyError::Kind::none;
      continue;
    }
    excess.before_kinetic = excess.of_free_joints
                                ? error_of_free_joints(tree, work, problem.mass_of(i), momentum,
                                                       after, problem.time_step, held, out)
                                : error_before_kinetic(tree, work, problem.mass_of(i), momentum,
                                                       after, problem.time_step);
  }
}

void add_lift_energy(const Problem& problem, Workspace& work, IslandEnergyErrors& out) {
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    EnergyError& excess = out.of_trees[i];
    if (excess.kind == EnergyError::Kind::none || excess.of_free_joints) continue;
    excess.before_kinetic +=
        lift_energy(*problem.trees[i], work, problem.velocity.data() + problem.offset[i]);
  }
}

void correct_energy(Tree& tree, Workspace& work, const EnergyError& excess,
                    std::span<const unsigned char> held, bool grounded) {
  if (excess.kind == EnergyError::Kind::none) return;
  if (excess.of_free_joints)
    return correct_free_joint_energy(tree, work, held, excess.before_kinetic);
  double sum = excess.before_kinetic + kinetic_energy(tree);
  if (is_driven(held) && sum < wild * kinetic_energy(tree)) return;
  if (tree.is_single_body) {
    if (grounded) restore_rotation_energy(tree, sum);
  } else {
    sum -= correct_joint_energy(tree, work, held, sum);
    if (!grounded && tree.has_floating_base)
      return;  // its momentum is right, and so is the energy of its rotation
  }
  const double most = kinetic_energy(tree) - sum;
  remove_kinetic_energy(tree, work, sum);
  if (grounded) scale_velocities(tree, most);
}

bool exceeds_rounding(const Tree& tree, double excess) {
  return excess > least * kinetic_energy(tree);
}

void remove_kinetic_energy(Tree& tree, Workspace& work, double excess) {
  if (!exceeds_rounding(tree, excess)) return;
  const double all = kinetic_energy(tree);
  if (!tree.has_floating_base) {
    const double share = velocity_scale(all, excess);
    for (double& speed : tree.v) speed *= share;
    return velocity_kinematics(tree);
  }
  if (!tree.is_single_body) {
    double stiff = 0;
    const Vector6 motion = rigid_motion(tree, work, stiff);
    const double joints = std::max(0.0, all - stiff), share = velocity_scale(joints, excess);
    for (int k = 0; k < tree.dofs; ++k) {
      const double kept = k < 6 ? motion[k] : 0;
      tree.v[k] = kept + share * (tree.v[k] - kept);
    }
    velocity_kinematics(tree);
    excess -= joints;
    if (excess <= 0) return;
  }
  double mass = 0;
  const Vector3 drift = mean_velocity(tree, mass);
  const double turning = kinetic_energy(tree) - mass * drift.squaredNorm() / 2;
  const double share = velocity_scale(turning, excess);
  for (double& speed : tree.v) speed *= share;
  for (int k = 0; k < 3; ++k) tree.v[3 + k] += (1 - share) * drift[k];
  velocity_kinematics(tree);
}

void remove_kinetic_energy(std::span<Tree* const> trees, Workspace& work, double excess) {
  double all = 0;
  for (const Tree* tree : trees) all += kinetic_energy(*tree);
  if (excess <= 0 || all <= 0) return;
  const double share = excess / all;
  for (Tree* tree : trees) remove_kinetic_energy(*tree, work, share * kinetic_energy(*tree));
}

double energy(std::span<Tree* const> trees) {
  double sum = 0;
  for (const Tree* tree : trees) {
    sum += kinetic_energy(*tree);
    for (std::size_t i = 0; i < tree->links.size(); ++i) {
      sum -= tree->links[i].mass * tree->gravity.dot(tree->position[i]);
    }
  }
  return sum;
}

}  // namespace ziggurat::dynamics
