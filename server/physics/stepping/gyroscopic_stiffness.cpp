// SPDX-License-Identifier: MIT
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "physics/stepping/geometric_stiffness.h"

namespace ziggurat::dynamics {
namespace {

/// Largest rotation of a nutating axis within an undivided step, and within a part of a divided one
/// [rad].
constexpr double too_far = 0.2, of_a_part = 0.12;
/// Largest island that is divided for nutation.
constexpr std::size_t most_trees = 8;
/// Gap below which surfaces count as touching: a step that is too long may wrongly separate them
/// [m].
constexpr double close = 1e-4;

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Nutation rate of a body [rad/s]; 0 where it spins about a principal axis.
/// @param inertia  principal;  @param spin  along these axes
double nutation(const Vector3& inertia, const Vector3& spin) {
  constexpr double little = 1e-4;  // sine of the angle between spin and angular momentum
  const Vector3 momentum = spin.cwiseProduct(inertia);
  if (!(spin.cross(momentum).norm() > little * spin.norm() * momentum.norm())) return 0;
  Vector3 sorted = inertia;
  std::sort(sorted.begin(), sorted.end());
  return spin.norm() * (sorted[2] - sorted[0]) / sorted[1];
}

/// Nutation rate of a tree as one rigid body [rad/s].
/// @param slow  slower spins count as none
double nutation_of_whole(const Problem& problem, std::size_t index, double slow) {
  const Tree& tree = *problem.trees[index];
  const Vector3 spin = tree.spatial_velocity[0].angular;
  if (!tree.has_floating_base || spin.norm() <= slow) return 0;
  const double* mass = problem.mass_of(index);
  Matrix6 root;
  for (int i = 0; i < 6; ++i) root.row(i) = Eigen::Map<const Vector6>(mass + i * tree.dofs);
  // Inertia about the centre of mass, which moves freely.
  const Matrix3 coupling = root.topRightCorner<3, 3>();
  const Matrix3 inertia = root.topLeftCorner<3, 3>() - coupling * coupling.transpose() / root(3, 3);
  const Eigen::SelfAdjointEigenSolver<Matrix3> principal(inertia);
  return nutation(principal.eigenvalues(), principal.eigenvectors().transpose() * spin);
}

/// Mobility of a link's rotation in a plane: the root of the determinant of its 2 x 2 block [1/(kg
/// m^2)].
/// @param normal  of the plane;  @param work  with the tree's factors;  @param memory  of each dof
double mobility_across(const Tree& tree, std::size_t link, const Vector3& normal,
                       const Workspace& work, std::vector<double>& memory) {
  const Vector3 one = normal.unitOrthogonal(), other = normal.cross(one);
  const auto turn = [&](const Vector3& torque) {
    memory.assign(tree.dofs, 0.0);
    for (const int k : tree.dofs_of(static_cast<int>(link)))
      memory[k] = torque.dot(tree.motion_subspace[k].angular);
    solve_mass_matrix(tree, work, memory.data());
    Vector3 change = Vector3::Zero();
    for (const int k : tree.dofs_of(static_cast<int>(link)))
      change += tree.motion_subspace[k].angular * memory[k];
    return change;
  };
  const Vector3 by_one = turn(one), by_other = turn(other);
  return std::sqrt(
      std::max(0.0, one.dot(by_one) * other.dot(by_other) - one.dot(by_other) * other.dot(by_one)));
}

/// Nutation rate of a tree's rotors on revolute joints [rad/s], by their largest angular momentum
/// in the step: a motor may spin them up within one.
/// @param slow  slower rotors are skipped
double nutation_of_rotors(const Problem& problem, std::size_t index, double slow, Workspace& work) {
  const Tree& tree = *problem.trees[index];
  double fastest = 0;
  bool factored = false;
  for (std::size_t i = 1; i < tree.links.size(); ++i) {
    const Link& link = tree.links[i];
    const Link& carrier = tree.links[link.parent];
    if (link.joint != JointType::revolute || carrier.joint == JointType::fixed) continue;
    const int dof = tree.first_dof[i];
    const double speed =
        std::max(std::abs(tree.v[dof]), std::abs(problem.velocity[problem.offset[index] + dof]));
    const double little = slow * (link.inertia.minCoeff() + carrier.inertia.minCoeff());
    if (link.inertia.maxCoeff() * speed <= little) continue;  // about any axis
    const Vector3 axis = tree.rotation[i].transpose() * tree.motion_subspace[dof].angular;
    const double momentum = link.inertia.dot(axis.cwiseAbs2()) * speed;
    if (momentum <= little) continue;
    if (!std::exchange(factored, true)) {
      work.mass.assign(problem.mass_of(index), problem.mass_of(index) + tree.dofs * tree.dofs);
      factor_mass_matrix(tree, work, problem.time_step);
    }
    fastest =
        std::max(fastest, momentum * mobility_across(tree, i, tree.motion_subspace[dof].angular,
                                                     work, work.saved_state));
  }
  return fastest;
}

}  // namespace

int parts_for_gyroscopic_stiffness(const Problem& problem, Workspace& work) {
  if (problem.trees.size() > most_trees) return 1;
  double fastest = 0;
  for (std::size_t index = 0; index < problem.trees.size(); ++index) {
    const Tree& tree = *problem.trees[index];
    const auto touches = [&](const Constraint& constraint) {
      const int it = static_cast<int>(index);
      return constraint.kind == Constraint::Kind::contact &&
             (constraint.a == it || constraint.b == it) &&
             (constraint.impulse[0] != 0 || constraint.gap < close);
    };
    const double slow = too_far / problem.time_step;
    const double its = tree.is_single_body
                           ? nutation(tree.links[0].inertia, tree.rotation[0].transpose() *
                                                                 tree.spatial_velocity[0].angular)
                           : std::max(nutation_of_whole(problem, index, slow),
                                      nutation_of_rotors(problem, index, slow, work));
    if (its > fastest && std::ranges::any_of(problem.constraints, touches)) fastest = its;
  }
  const double most = problem.time_step * fastest;
  return most > too_far ? static_cast<int>(std::min(std::ceil(most / of_a_part), 1e6)) : 1;
}

}  // namespace ziggurat::dynamics
