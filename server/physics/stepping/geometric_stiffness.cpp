// SPDX-License-Identifier: MIT
#include "physics/stepping/geometric_stiffness.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace ziggurat::dynamics {
namespace {

/// Largest swing of a link within an undivided step, and within a part of a divided one [rad].
/// Neighbours swing against each other up to twice as fast, and from 2 rad on that is unstable.
constexpr double swings_too_far = 0.7, swing_of_a_part = 0.5;

/// Whether a servo or a limit holds a coordinate.
bool holds_joint(const Constraint& constraint) {
  return constraint.kind != Constraint::Kind::contact && constraint.dofs_a.size() == 1 &&
         constraint.is_unsaturated();
}

/// Counts free joint coordinates of each tree. A tree whose joints are all held is a rigid body,
/// and does not swing.
/// @return  whether any is
bool find_unconstrained(const Problem& problem, GeometricStiffness& memory) {
  memory.free.clear();
  for (const Tree* tree : problem.trees) memory.free.push_back(tree->dofs - tree->dof_count[0]);
  for (const Constraint& constraint : problem.constraints) {
    if (holds_joint(constraint)) --memory.free[constraint.a];
  }
  return std::ranges::any_of(memory.free, [](int count) { return count > 0; });
}

/// Adds the impulses of contacts on each link, about its centre of mass.
void add_contacts(const Problem& problem, std::span<const ContactPoint> contacts,
                  GeometricStiffness& memory) {
  for (const Constraint& constraint : problem.constraints) {
    if (constraint.kind != Constraint::Kind::contact || constraint.impulse[0] == 0) continue;
    const ContactPoint& contact = contacts[constraint.source];
    const Vector3 impulse = constraint.frame * Vector3(constraint.impulse[0], constraint.impulse[1],
                                                       constraint.impulse[2]);
    const auto add = [&](int index, int link, const Vector3& point, double sign) {
      if (index < 0) return;
      const int at = memory.first_link[index] + link;
      memory.impulse[at] += sign * impulse;
      memory.dyad[at] +=
          sign * (point - problem.trees[index]->position[link]) * impulse.transpose();
    };
    add(constraint.a, contact.a.link, contact.point, 1);
    add(constraint.b, contact.b.link, contact.point + contact.offset_to_b, -1);
  }
}

/// Adds the impulses of external forces, and of inertia against the change of velocity.
void add_inertia(const Problem& problem, std::size_t i, GeometricStiffness& memory) {
  const Tree& tree = *problem.trees[i];
  const double* after = problem.velocity.data() + problem.offset[i];
  memory.change.resize(tree.links.size());
  for (std::size_t link = 0; link < tree.links.size(); ++link) {
    Motion& change = memory.change[link];
    change = link > 0 ? memory.change[tree.links[link].parent] : Motion{};
    const int first = tree.first_dof[link];
    for (int k = first; k < first + tree.dof_count[link]; ++k)
      change = change + tree.motion_subspace[k] * (after[k] - tree.v[k]);
    if (tree.links[link].joint == JointType::fixed) continue;
    const Vector3 faster = change.linear + change.angular.cross(tree.position[link] - tree.origin);
    memory.impulse[memory.first_link[i] + link] +=
        problem.time_step * tree.external[link].force +
        tree.links[link].mass * (problem.time_step * tree.gravity - faster);
  }
}

/// Adds the impulses of joints, from the leaves to the root.
void add_joints(const Tree& tree, Vector3* impulse, Matrix3* dyad) {
  for (std::size_t link = tree.links.size() - 1; link > 0; --link) {
    const int parent = tree.links[link].parent;
    const Vector3 joint =
        tree.position[parent] + tree.rotation[parent] * tree.links[link].joint_in_parent.position;
    dyad[link] -= (joint - tree.position[link]) * impulse[link].transpose();
    dyad[parent] += (joint - tree.position[parent]) * impulse[link].transpose();
    impulse[parent] += impulse[link];
  }
}

/// h K of a link.
Matrix3 stiffness(const Matrix3& dyad) {
  return dyad.trace() * Matrix3::Identity() - (dyad + dyad.transpose()) / 2;
}

/// Whether a link may swing too far, by its own inertia alone.
/// @param stiff  h^2 K
bool may_swing(const Tree& tree, std::size_t link, const Matrix3& stiff) {
  if (tree.links[link].joint == JointType::fixed) return false;
  // All eigenvalues are below a bound if the bound minus the matrix is positive definite
  // (Sylvester).
  const double bound = swings_too_far * swings_too_far / 4 * tree.links[link].inertia.minCoeff();
  const Matrix3 rest = bound * Matrix3::Identity() - stiff;
  const double minor = rest(0, 0) * rest(1, 1) - rest(0, 1) * rest(0, 1);
  return !(rest(0, 0) > 0 && minor > 0 && rest.determinant() > 0);
}

/// Squared swing rate of a link while all others move freely, times its step: of h K [rad^2/s].
/// @param work  with the tree's factors
double squared_swing_rate(const Tree& tree, int link, const Matrix3& stiff, const Workspace& work,
                          GeometricStiffness& memory) {
  const Eigen::SelfAdjointEigenSolver<Matrix3> parts(stiff);
  double most = 0;
  for (int part = 0; part < 3; ++part) {
    if (parts.eigenvalues()[part] <= 0) continue;  // pressed
    const Vector3 axis = parts.eigenvectors().col(part);
    memory.direction.assign(tree.dofs, 0.0);
    for (const int k : tree.dofs_of(link))
      memory.direction[k] = axis.dot(tree.motion_subspace[k].angular);
    memory.response = memory.direction;
    solve_mass_matrix(tree, work, memory.response.data());
    const double mobility = std::inner_product(memory.direction.begin(), memory.direction.end(),
                                               memory.response.begin(), 0.0);
    most = std::max(most, parts.eigenvalues()[part] * mobility);
  }
  return most;
}

/// Factors the tree's matrix with held joints as heavy dofs.
void factor_with_held_joints(const Problem& problem, std::size_t i, Workspace& work) {
  constexpr double heavy = 1e6;
  const Tree& tree = *problem.trees[i];
  work.mass.assign(problem.mass_of(i), problem.mass_of(i) + tree.dofs * tree.dofs);
  for (const Constraint& constraint : problem.constraints) {
    if (constraint.a == static_cast<int>(i) && holds_joint(constraint))
      work.mass[constraint.dofs_a[0] * (tree.dofs + 1)] *= heavy;
  }
  factor_mass_matrix(tree, work, problem.time_step);
}

/// Largest swing of a tree's links in the step [rad].
double swing_angle(const Problem& problem, std::size_t i, Workspace& work,
                   GeometricStiffness& memory) {
  const Tree& tree = *problem.trees[i];
  Matrix3* dyad = memory.dyad.data() + memory.first_link[i];
  add_inertia(problem, i, memory);
  add_joints(tree, memory.impulse.data() + memory.first_link[i], dyad);
  bool factored = false;
  double most = 0;
  for (std::size_t link = 0; link < tree.links.size(); ++link) {
    const Matrix3 stiff = stiffness(dyad[link]);
    if (!may_swing(tree, link, problem.time_step * stiff)) continue;
    if (!factored) factor_with_held_joints(problem, i, work);
    factored = true;
    most = std::max(most, problem.time_step * squared_swing_rate(tree, static_cast<int>(link),
                                                                 stiff, work, memory));
  }
  return std::sqrt(most);
}

}  // namespace

int parts_for_geometric_stiffness(const Problem& problem, std::span<const ContactPoint> contacts,
                                  Workspace& work, GeometricStiffness& memory) {
  if (!find_unconstrained(problem, memory)) return 1;
  memory.first_link.clear();
  int links = 0;
  for (const Tree* tree : problem.trees) {
    memory.first_link.push_back(links);
    links += static_cast<int>(tree->links.size());
  }
  memory.impulse.assign(links, Vector3::Zero());
  memory.dyad.assign(links, Matrix3::Zero());
  add_contacts(problem, contacts, memory);
  double most = 0;
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    if (memory.free[i] > 0) most = std::max(most, swing_angle(problem, i, work, memory));
  }
  return most > swings_too_far ? static_cast<int>(std::min(std::ceil(most / swing_of_a_part), 1e6))
                               : 1;
}

}  // namespace ziggurat::dynamics
