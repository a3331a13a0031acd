#include "dynamics/excess.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace ziggurat::dynamics {
namespace {

constexpr double far = 0.1;         // [rad] per substep
constexpr double negligible = 1e-6;  // of the kinetic energy

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Velocities of a free root with which the tree, stiff, has the same momentum and angular momentum.
/// @param energy  then [J]
Vector6 stiff_motion(const Tree& tree, Workspace& work, double& energy) {
  compute_mass(tree, work);
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

/// Of the part of the speeds that has this energy, what is left without the excess.
double share_left(double energy, double excess) {
  return energy > excess ? std::sqrt(1 - excess / energy) : 0;
}

/// Whether links turn so far within a substep that it matters.
/// @param after  velocities that were found
bool turns_far(const Tree& tree, std::span<const double> after, double length) {
  const double most = far * far / (length * length);
  for (int k = 0; k < tree.dofs; ++k) {
    if (tree.axes[k].angular.squaredNorm() * after[k] * after[k] > most) return true;
  }
  return std::any_of(tree.motion.begin(), tree.motion.end(), [&](const Motion& motion) {
    return motion.angular.squaredNorm() > most;
  });
}

/// The excess, less the kinetic energy that the tree has at the end; at its state of the beginning.
/// @param mass      its matrix, dofs x dofs
/// @param momentum  that it was solved with, see momentum_after()
/// @param after     velocities that were found
/// @return          [J]
double excess_before(const Tree& tree, Workspace& work, const double* mass,
                     std::span<const double> momentum, std::span<const double> after,
                     double length) {
  // With b = M (after - before) - h (forces) - J^T g, what turning alone adds to the momentum, the work
  // b (before + after) / 2 and the change of after^T M after / 2 with the pose should cancel.
  work.scratch.resize(tree.dofs);
  external_forces(tree, work, work.scratch, true, true);
  double sum = 0;
  for (int i = 0; i < tree.dofs; ++i) {
    double before = 0, energy = 0;
    for (int j = 0; j < tree.dofs; ++j) {
      before += mass[i * tree.dofs + j] * tree.v[j];
      energy += mass[i * tree.dofs + j] * after[j] / 2;
    }
    const double added = momentum[i] - before - length * work.scratch[i] -
                         length * tree.damping[i] * after[i];
    sum += added * (tree.v[i] + after[i]) / 2 - energy * after[i];
  }
  return sum;
}

/// The potential energy that a displacement gives a tree, if it is lifted.
/// @param by  of each dof [m], [rad]
/// @return    [J], >= 0
double lift(const Tree& tree, Workspace& work, const double* by) {
  work.scratch.resize(tree.dofs);
  external_forces(tree, work, work.scratch, false, true);
  double sum = 0;
  for (int k = 0; k < tree.dofs; ++k) sum -= work.scratch[k] * by[k];
  return std::max(0.0, sum);
}

}  // namespace

void note_excesses(const Problem& problem, Workspace& work, std::vector<std::optional<double>>& out) {
  out.assign(problem.trees.size(), std::nullopt);
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    const Tree& tree = *problem.trees[i];
    const std::size_t first = problem.offset[i], dofs = tree.dofs;
    const auto after = std::span(problem.velocity).subspan(first, dofs);
    if (!turns_far(tree, after, problem.length)) continue;
    out[i] = excess_before(tree, work, problem.mass_of(i),
                           std::span(problem.momentum).subspan(first, dofs), after, problem.length);
  }
}

void add_lifts(const Problem& problem, Workspace& work, std::vector<std::optional<double>>& out) {
  const auto bounces = [](const Block& block) { return block.bounces; };
  if (std::any_of(problem.blocks.begin(), problem.blocks.end(), bounces)) return;
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    if (!out[i]) continue;
    *out[i] += lift(*problem.trees[i], work, problem.velocity.data() + problem.offset[i]);
  }
}

bool gains_much(const Tree& tree, double excess) {
  return excess > negligible * kinetic_energy(tree);
}

void take_excess(Tree& tree, Workspace& work, double excess) {
  if (!gains_much(tree, excess)) return;
  const double all = kinetic_energy(tree);
  if (!tree.free_root) {
    const double share = share_left(all, excess);
    for (double& speed : tree.v) speed *= share;
    return move(tree);
  }
  if (!tree.single) {
    double stiff = 0;
    const Vector6 motion = stiff_motion(tree, work, stiff);
    const double joints = std::max(0.0, all - stiff), share = share_left(joints, excess);
    for (int k = 0; k < tree.dofs; ++k) {
      const double kept = k < 6 ? motion[k] : 0;
      tree.v[k] = kept + share * (tree.v[k] - kept);
    }
    move(tree);
    excess -= joints;
    if (excess <= 0) return;
  }
  double mass = 0;
  const Vector3 drift = mean_velocity(tree, mass);
  const double turning = kinetic_energy(tree) - mass * drift.squaredNorm() / 2;
  const double share = share_left(turning, excess);
  for (double& speed : tree.v) speed *= share;
  for (int k = 0; k < 3; ++k) tree.v[3 + k] += (1 - share) * drift[k];
  move(tree);
}

void take_excess(std::span<Tree* const> trees, Workspace& work, double excess) {
  double all = 0;
  for (const Tree* tree : trees) all += kinetic_energy(*tree);
  if (excess <= 0 || all <= 0) return;
  const double share = excess / all;
  for (Tree* tree : trees) take_excess(*tree, work, share * kinetic_energy(*tree));
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
