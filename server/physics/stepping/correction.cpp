// SPDX-License-Identifier: MIT
#include "physics/stepping/correction.h"

#include <algorithm>

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
void restore_momentum(Tree& tree, Workspace& work, const double* mass,
                      std::span<const double, 6> drift) {
  Vector6 before = momentum(tree, mass);
  for (int i = 0; i < 6; ++i) before[i] += drift[i];
  compute_mass_matrix(tree, work);
  const Vector3 moved =
      centre_of_mass(tree, work.mass.data()) - centre_of_mass(tree, mass);  // from the origin
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

bool conserves_momentum(const IslandEnd& end, std::size_t index) {
  const Tree& tree = *end.problem.trees[index];
  if (!has_free_base(tree)) return false;
  const EnergyError& error = end.energy_errors.of_trees[index];
  const bool gains = error.kind != EnergyError::Kind::none && !error.of_free_joints &&
                     exceeds_rounding(tree, error.before_kinetic + kinetic_energy(tree));
  return gains || !end.has_world_friction;
}

void restore_momentum(const IslandEnd& end, std::size_t index) {
  restore_momentum(*end.problem.trees[index], end.work, end.problem.mass_of(index),
                   end.problem.root_bias_impulse[index]);
}

bool has_energy_error(const IslandEnd& end, std::size_t index) {
  return end.energy_errors.of_trees[index].kind != EnergyError::Kind::none;
}

void correct_energy(const IslandEnd& end, std::size_t index) {
  Tree& tree = *end.problem.trees[index];
  const auto held = std::span(end.energy_errors.held).subspan(end.problem.offset[index], tree.dofs);
  dynamics::correct_energy(tree, end.work, end.energy_errors.of_trees[index], held,
                           end.has_world_friction);
}

}  // namespace

const std::array<Correction, 2> corrections{{
    {"momentum of floating trees", conserves_momentum, restore_momentum},
    {"energy of rotation", has_energy_error, correct_energy},
}};

bool has_world_friction(const Problem& problem) {
  return std::ranges::any_of(problem.constraints, [](const Constraint& b) {
    return b.kind == Constraint::Kind::contact && (b.a < 0 || b.b < 0) && b.friction[0] > 0;
  });
}

void correct(const IslandEnd& end) {
  for (const Correction& correction : corrections) {
    for (std::size_t i = 0; i < end.problem.trees.size(); ++i) {
      if (!end.is_free[i] && correction.applies(end, i)) correction.apply(end, i);
    }
  }
}

}  // namespace ziggurat::dynamics
