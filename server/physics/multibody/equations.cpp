// SPDX-License-Identifier: MIT
#include "physics/multibody/equations.h"

#include <algorithm>

namespace ziggurat::dynamics {
namespace {

/// Inertia of one link about the tree's origin.
Inertia link_inertia(const Tree& tree, int i) {
  return inertia_about(tree.links[i], tree.rotation[i], tree.position[i] - tree.origin);
}

/// Sets the generalised forces of the first dofs of a floating base, which are along the world's
/// axes.
void set_root_forces(const Wrench& wrench, std::span<double> out) {
  for (int k = 0; k < 3; ++k) {
    out[k] = wrench.moment[k];
    out[3 + k] = wrench.force[k];
  }
}

/// Projects the wrenches on all links on each dof. Each link's wrench becomes the sum over its
/// subtree.
void project_wrenches(const Tree& tree, std::vector<Wrench>& wrenches, std::span<double> out) {
  for (int i = static_cast<int>(tree.links.size()) - 1; i > 0; --i) {
    const int first = tree.first_dof[i];
    for (int k = first; k < first + tree.dof_count[i]; ++k) {
      out[k] = dot(tree.motion_subspace[k], wrenches[i]);
    }
    Wrench& parent = wrenches[tree.links[i].parent];
    parent = parent + wrenches[i];
  }
  if (tree.has_floating_base) return set_root_forces(wrenches[0], out);
  for (int k = 0; k < tree.dof_count[0]; ++k) out[k] = dot(tree.motion_subspace[k], wrenches[0]);
}

/// Sets the mass matrix of a floating base with a composite inertia.
void set_root_mass(const Inertia& inertia, double* mass, int n) {
  const Vector3& h = inertia.first_moment;
  const double coupling[3][3] = {{0, -h.z(), h.y()}, {h.z(), 0, -h.x()}, {-h.y(), h.x(), 0}};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      mass[i * n + j] = inertia.second_moment(i, j);
      mass[i * n + 3 + j] = mass[(3 + j) * n + i] = coupling[i][j];
      mass[(3 + i) * n + 3 + j] = i == j ? inertia.mass : 0;
    }
  }
}

/// Mass matrix of a gyrostat, and its inertia in the world.
void set_gyrostat_mass(const Tree& tree, Workspace& work) {
  const Matrix3& r = tree.rotation[0];
  const Inertia& fixed = tree.gyrostat->inertia;
  Inertia& inertia = work.composite_inertia[0];
  inertia.mass = fixed.mass;
  inertia.first_moment = r * fixed.first_moment;
  inertia.second_moment.noalias() = r * fixed.second_moment * r.transpose();
  const int n = tree.dofs;
  double* mass = work.mass.data();
  std::fill_n(mass, n * n, 0.0);
  set_root_mass(inertia, mass, n);
  for (int k = 6; k < n; ++k) {
    const double axial = tree.gyrostat->axial_inertia[k];
    const Vector3& axis = tree.motion_subspace[k].angular;
    for (int j = 0; j < 3; ++j) mass[k * n + j] = mass[j * n + k] = axial * axis[j];
    mass[k * n + k] = axial;
  }
}

/// Bias forces of a gyrostat, and its momenta: rates of change of the momentum of the whole and of
/// what its rotors have more. Symmetry leaves the rotors' own momenta as they are.
void gyrostat_bias_forces(const Tree& tree, Workspace& work, std::span<double> out) {
  const Inertia& inertia = work.composite_inertia[0];
  const Motion& motion = tree.spatial_velocity[0];
  work.momentum.resize(tree.dofs);
  Wrench momentum = inertia * motion;
  Vector3 spin = inertia.second_moment * motion.angular;
  for (int k = 6; k < tree.dofs; ++k) {
    const double axial = tree.gyrostat->axial_inertia[k];
    const Vector3& axis = tree.motion_subspace[k].angular;
    work.momentum[k] = axial * (axis.dot(motion.angular) + tree.v[k]);
    const Vector3 more = axial * tree.v[k] * axis;
    momentum.moment += more;
    spin += more;
    out[k] = 0;
  }
  set_root_forces(momentum, work.momentum);
  set_root_forces({motion.angular.cross(spin),
                   motion.angular.cross(motion.angular.cross(inertia.first_moment))},
                  out);
}

}  // namespace

void compute_mass_matrix(const Tree& tree, Workspace& work) {
  const int size = static_cast<int>(tree.links.size()), n = tree.dofs;
  work.link_inertia.resize(size);
  work.composite_inertia.resize(size);
  work.wrench.resize(size);
  work.acceleration.resize(size);
  work.scratch.resize(n);
  work.mass.resize(n * n);
  if (tree.gyrostat) return set_gyrostat_mass(tree, work);
  for (int i = 0; i < size; ++i) {
    work.link_inertia[i] =
        tree.links[i].joint == JointType::fixed ? Inertia{} : link_inertia(tree, i);
    work.composite_inertia[i] = work.link_inertia[i];
  }
  if (size > 1) work.mass.assign(work.mass.size(), 0);  // dofs on different branches do not couple
  const int root = tree.has_floating_base ? 6 : 0;      // dofs along the world's axes
  for (int i = size - 1; i >= 0; --i) {
    const int first = tree.first_dof[i];
    for (int k = std::max(first, root); k < first + tree.dof_count[i]; ++k) {
      const Wrench momentum = work.composite_inertia[i] * tree.motion_subspace[k];
      for (int j = k; j >= root; j = tree.parent_dof[j]) {
        work.mass[k * n + j] = work.mass[j * n + k] = dot(tree.motion_subspace[j], momentum);
      }
      for (int j = 0; j < root; ++j) {
        const double part = j < 3 ? momentum.moment[j] : momentum.force[j - 3];
        work.mass[k * n + j] = work.mass[j * n + k] = part;
      }
    }
    if (i > 0) work.composite_inertia[tree.links[i].parent] += work.composite_inertia[i];
  }
  if (tree.has_floating_base) set_root_mass(work.composite_inertia[0], work.mass.data(), n);
}

namespace {

/// Adds the products of R rows: those of as many columns, because M is symmetric.
template <int R>
void add_rows(const double* columns, double factor, const double* v, int n, double* out) {
  using Rows = Eigen::Array<double, R, 1>;
  Eigen::Map<Rows> rows(out);
  Rows sum = rows;
  for (int k = 0; k < n; ++k) sum += Eigen::Map<const Rows>(columns + k * n) * (factor * v[k]);
  rows = sum;
}

}  // namespace

void add_momentum(const double* mass, double factor, const double* v, int n, double* out) {
  int i = 0;
  for (; i + 8 <= n; i += 8) add_rows<8>(mass + i, factor, v, n, out + i);
  for (; i + 2 <= n; i += 2) add_rows<2>(mass + i, factor, v, n, out + i);
  if (i < n) add_rows<1>(mass + i, factor, v, n, out + i);
}

void bias_accelerations(const Tree& tree, Workspace& work) {
  work.acceleration.resize(tree.links.size());
  for (int i = 0; i < static_cast<int>(tree.links.size()); ++i) {
    const Link& link = tree.links[i];
    const Motion& motion = tree.spatial_velocity[i];
    Motion& acceleration = work.acceleration[i];
    if (i == 0) {
      // The root's coordinates are of its centre of mass, which moves away from O.
      acceleration = {Vector3::Zero(), -motion.angular.cross(motion.linear)};
    } else {
      acceleration = work.acceleration[link.parent];
      Motion relative;
      const int first = tree.first_dof[i];
      for (int k = first; k < first + tree.dof_count[i]; ++k) {
        relative = relative + tree.motion_subspace[k] * tree.v[k];
      }
      acceleration = acceleration + cross(tree.spatial_velocity[link.parent], relative);
    }
  }
}

void bias_forces(const Tree& tree, Workspace& work, std::span<double> out) {
  if (tree.gyrostat) return gyrostat_bias_forces(tree, work, out);
  bias_accelerations(tree, work);
  work.link_momentum.resize(tree.links.size());
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    if (tree.links[i].joint == JointType::fixed) {
      work.link_momentum[i] = work.wrench[i] = Wrench{};
      continue;
    }
    const Inertia& inertia = work.link_inertia[i];
    const Motion& motion = tree.spatial_velocity[i];
    work.link_momentum[i] = inertia * motion;
    work.wrench[i] = inertia * work.acceleration[i] + cross(motion, work.link_momentum[i]);
  }
  project_wrenches(tree, work.wrench, out);
  work.momentum.resize(tree.dofs);
  project_wrenches(tree, work.link_momentum, work.momentum);
}

void gravity_forces(const Tree& tree, const Workspace& work, std::span<double> out) {
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    const Inertia& inertia = work.composite_inertia[i];
    const Wrench weight{inertia.first_moment.cross(tree.gravity), inertia.mass * tree.gravity};
    if (i == 0 && tree.has_floating_base) {
      set_root_forces(weight, out);
      if (!tree.gyrostat) continue;
      std::fill(out.begin() + 6, out.end(), 0.0);  // rotors are balanced
      return;
    }
    const int first = tree.first_dof[i];
    for (int k = first; k < first + tree.dof_count[i]; ++k)
      out[k] = dot(tree.motion_subspace[k], weight);
  }
}

void external_forces(const Tree& tree, Workspace& work, std::span<double> out, bool fields,
                     bool gravity) {
  work.wrench.resize(tree.links.size());  // the workspace may have served a smaller tree since
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    const Vector3 arm = tree.position[i] - tree.origin;
    Vector3 force = Vector3::Zero();
    if (fields) force += tree.external[i].force;
    if (gravity) force += tree.gravity * tree.links[i].mass;
    work.wrench[i] = {arm.cross(force), force};
    if (fields) work.wrench[i].moment += tree.external[i].moment;
  }
  project_wrenches(tree, work.wrench, out);
}

void factor_mass_matrix(const Tree& tree, Workspace& work, double time_step) {
  const int n = tree.dofs;
  work.factor.resize(n * n);
  const int* parent = tree.parent_dof.data();
  double* m = work.factor.data();
  std::copy(work.mass.begin(), work.mass.end(), m);
  for (int k = 0; k < n; ++k) m[k * n + k] += time_step * tree.damping[k];
  for (int k = n - 1; k >= 0; --k) {
    const double inverse = 1 / m[k * n + k];
    for (int i = parent[k]; i >= 0; i = parent[i]) {
      const double ratio = m[k * n + i] * inverse;
      for (int j = i; j >= 0; j = parent[j]) m[i * n + j] -= ratio * m[k * n + j];
    }
    for (int i = parent[k]; i >= 0; i = parent[i]) m[k * n + i] *= inverse;
    m[k * n + k] = inverse;
  }
}

void solve_mass_matrix(const Tree& tree, const Workspace& work, double* x) {
  const int n = tree.dofs;
  const int* parent = tree.parent_dof.data();
  const double* m = work.factor.data();
  for (int i = n - 1; i >= 0; --i) {
    for (int j = parent[i]; j >= 0; j = parent[j]) x[j] -= m[i * n + j] * x[i];
  }
  for (int i = 0; i < n; ++i) {
    x[i] *= m[i * n + i];
    for (int j = parent[i]; j >= 0; j = parent[j]) x[i] -= m[i * n + j] * x[j];
  }
}

double mobility(const Tree& tree, Workspace& work, int dof) {
  // x = L^-T e has entries on the way from the dof to the root only.
  const int n = tree.dofs;
  const double* m = work.factor.data();
  double* x = work.scratch.data();
  for (int j = dof; j >= 0; j = tree.parent_dof[j]) x[j] = j == dof ? 1 : 0;
  double sum = 0;
  for (int i = dof; i >= 0; i = tree.parent_dof[i]) {
    for (int j = tree.parent_dof[i]; j >= 0; j = tree.parent_dof[j]) x[j] -= m[i * n + j] * x[i];
    sum += x[i] * x[i] * m[i * n + i];
  }
  return sum;
}

void solve_prescribed(const Tree& tree, Workspace& work, const PrescribedJoints& drive,
                      std::span<double> x) {
  const int n = tree.dofs;
  for (std::size_t k = 0; k < drive.prescribed.size(); ++k) {
    if (!drive.prescribed[k]) continue;
    for (int i = 0; i < n; ++i) {
      if (!drive.prescribed[i]) x[i] -= work.mass[i * n + k] * x[k];
      work.mass[i * n + k] = work.mass[k * n + i] = 0;
    }
    work.mass[k * n + k] = 1;
  }
  factor_mass_matrix(tree, work, 0);
  solve_mass_matrix(tree, work, x.data());
}

namespace {

Vector6 vector_of(const Motion& motion) {
  return (Vector6() << motion.angular, motion.linear).finished();
}

/// Bias acceleration of a link relative to its parent. The root's coordinates are of its centre of
/// mass, which moves away from O.
Motion relative_bias(const Tree& tree, int i) {
  const Motion& motion = tree.spatial_velocity[i];
  if (i == 0) return {Vector3::Zero(), -motion.angular.cross(motion.linear)};
  Motion relative;
  const int first = tree.first_dof[i];
  for (int k = first; k < first + tree.dof_count[i]; ++k) {
    relative = relative + tree.motion_subspace[k] * tree.v[k];
  }
  return cross(tree.spatial_velocity[tree.links[i].parent], relative);
}

/// Sets a body to a link alone, under gravity.
void set_body(const Tree& tree, int i, ArticulatedBody& body) {
  const Inertia inertia = link_inertia(tree, i);
  const Vector3& h = inertia.first_moment;
  Matrix3 coupling;
  coupling << 0, -h.z(), h.y(), h.z(), 0, -h.x(), -h.y(), h.x(), 0;
  body.inertia << inertia.second_moment, coupling, coupling.transpose(),
      inertia.mass * Matrix3::Identity();
  const Motion& motion = tree.spatial_velocity[i];
  const Wrench weight{h.cross(tree.gravity), inertia.mass * tree.gravity};
  const Wrench wrench = cross(motion, inertia * motion) - weight;
  body.wrench << wrench.moment, wrench.force;
  body.bias = vector_of(relative_bias(tree, i));
}

/// Frees a dof of a body's joint: what is left is felt by the parent.
void free_dof(const Motion& axis, double force, ArticulatedBody& body, ArticulatedDof& dof) {
  const Vector6 along = vector_of(axis);
  dof.inertia.noalias() = body.inertia * along;
  dof.mobility = 1 / along.dot(dof.inertia);
  dof.force = force - along.dot(body.wrench);
  body.inertia.noalias() -= dof.inertia * (dof.mobility * dof.inertia).transpose();
  body.wrench += dof.inertia * (dof.mobility * dof.force);
}

}  // namespace

void forward_dynamics(Tree& tree, Workspace& work, const PrescribedJoints& drive,
                      std::span<double> out) {
  forward_kinematics(tree);
  velocity_kinematics(tree);
  const int size = static_cast<int>(tree.links.size());
  const int first_moving = tree.links[0].joint == JointType::fixed ? 1 : 0;
  work.bodies.resize(size);
  work.dofs.resize(tree.dofs);
  for (int i = first_moving; i < size; ++i) set_body(tree, i, work.bodies[i]);
  for (int i = size - 1; i >= first_moving; --i) {
    ArticulatedBody& body = work.bodies[i];
    for (int k = tree.first_dof[i] + tree.dof_count[i] - 1; k >= tree.first_dof[i]; --k) {
      work.dofs[k].mobility = 0;
      if (drive.prescribes(k)) continue;
      const double servo = drive.force.empty() ? 0 : drive.force[k];
      free_dof(tree.motion_subspace[k], servo - tree.damping[k] * tree.v[k], body, work.dofs[k]);
    }
    const int parent = tree.links[i].parent;
    if (i == 0 || parent < first_moving) continue;
    work.bodies[parent].inertia += body.inertia;
    work.bodies[parent].wrench += body.wrench + body.inertia * body.bias;
  }
  for (int i = first_moving; i < size; ++i) {
    ArticulatedBody& body = work.bodies[i];
    const int parent = tree.links[i].parent;
    body.acceleration = body.bias;
    if (i > 0 && parent >= first_moving) body.acceleration += work.bodies[parent].acceleration;
    for (int k = tree.first_dof[i]; k < tree.first_dof[i] + tree.dof_count[i]; ++k) {
      const ArticulatedDof& dof = work.dofs[k];
      out[k] = 0;
      if (dof.mobility == 0) continue;
      out[k] = dof.mobility * (dof.force - dof.inertia.dot(body.acceleration));
      body.acceleration += out[k] * vector_of(tree.motion_subspace[k]);
    }
  }
}

}  // namespace ziggurat::dynamics
