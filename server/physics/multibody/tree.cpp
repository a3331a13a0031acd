// SPDX-License-Identifier: MIT
#include "physics/multibody/tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "physics/multibody/prefetch.h"
#include "physics/multibody/rotation.h"

namespace ziggurat::dynamics {
namespace {

int position_count_of(JointType joint) {
  switch (joint) {
    case JointType::floating:
      return 7;
    case JointType::fixed:
      return 0;
    case JointType::spherical:
      return 4;
    default:
      return 1;
  }
}

/// Rotates a quaternion by the vector `turn`: q * exp(turn) about its own axes, or exp(turn) * q
/// about the fixed ones.
void rotate_quaternion(double* q, const Vector3& turn, bool right) {
  const Quaternion before(q[0], q[1], q[2], q[3]);
  const Quaternion by = exponential(turn);
  Quaternion after = right ? before * by : by * before;
  after.normalize();
  q[0] = after.w(), q[1] = after.x(), q[2] = after.y(), q[3] = after.z();
}

void root_kinematics(Tree& tree, const math::Pose& fixed) {
  if (tree.links[0].joint == JointType::fixed) {
    tree.rotation[0] = fixed.orientation.toRotationMatrix();
    tree.position[0] = tree.origin = fixed.position;
    return;
  }
  const double* q = tree.q.data();
  tree.rotation[0] = rotation_matrix(q + 3);
  tree.position[0] = tree.origin = Vector3(q[0], q[1], q[2]);
}

}  // namespace

Inertia inertia_about(const Link& link, const Matrix3& r, const Vector3& arm) {
  Inertia out;
  out.mass = link.mass;
  out.first_moment = link.mass * arm;
  const double square = out.first_moment.dot(arm);
  for (int a = 0; a < 3; ++a) {
    double scaled[3];
    for (int k = 0; k < 3; ++k) scaled[k] = r(a, k) * link.inertia[k];
    for (int b = a; b < 3; ++b) {
      double sum = -out.first_moment[a] * arm[b];
      for (int k = 0; k < 3; ++k) sum += scaled[k] * r(b, k);
      if (a == b) sum += square;
      out.second_moment(a, b) = out.second_moment(b, a) = sum;
    }
  }
  return out;
}

namespace {

/// Model of cleared trees.
const std::shared_ptr<const TreeModel>& empty_model() {
  static const auto mechanism = [] {
    std::vector<Link> links(1);
    links[0].joint = JointType::fixed;
    return std::make_shared<const TreeModel>(std::move(links), all_freedoms);
  }();
  return mechanism;
}

/// @param before, after  rotations of the joint in the parent, and of the link in the joint
RevoluteRotation revolute_rotation(const Matrix3& before, const Vector3& axis,
                                   const Matrix3& after) {
  Matrix3 across;  // the cross product with the axis
  across << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  const Matrix3 along = axis * axis.transpose();
  return {before * along * after, before * (Matrix3::Identity() - along) * after,
          before * across * after, before * axis};
}

}  // namespace

bool Link::operator==(const Link& other) const {
  const auto same = [](const math::Pose& a, const math::Pose& b) {
    return a.position == b.position && a.orientation.coeffs() == b.orientation.coeffs();
  };
  return parent == other.parent && joint == other.joint &&
         same(joint_in_parent, other.joint_in_parent) && same(joint_in_link, other.joint_in_link) &&
         axis == other.axis && mass == other.mass && inertia == other.inertia &&
         damping == other.damping;
}

TreeModel::TreeModel(std::vector<Link> with, unsigned with_freedoms)
    : links(std::move(with)), freedoms(with_freedoms) {
  const std::size_t size = links.size();
  first_dof.resize(size);
  dof_count.resize(size);
  first_position.resize(size);
  for (std::size_t i = 0; i < size; ++i) {
    const Link& link = links[i];
    first_dof[i] = dofs;
    first_position[i] = position_count;
    dof_count[i] = link.joint == JointType::floating    ? __builtin_popcount(freedoms)
                   : link.joint == JointType::fixed     ? 0
                   : link.joint == JointType::spherical ? 3
                                                        : 1;
    int carrier = link.parent;
    while (carrier >= 0 && dof_count[carrier] == 0) carrier = links[carrier].parent;
    int last = carrier < 0 ? -1 : first_dof[carrier] + dof_count[carrier] - 1;
    for (int k = 0; k < dof_count[i]; ++k) {
      parent_dof.push_back(last);
      damping.push_back(link.joint == JointType::floating ? 0 : link.damping);
      last = dofs + k;
    }
    dofs += dof_count[i];
    position_count += position_count_of(link.joint);
    joint_in_parent_rotation.push_back(link.joint_in_parent.orientation.toRotationMatrix());
    link_in_joint_rotation.push_back(link.joint_in_link.orientation.conjugate().toRotationMatrix());
    revolute.push_back(
        revolute_rotation(joint_in_parent_rotation[i], link.axis, link_in_joint_rotation[i]));
  }
  list_ancestor_dofs();
  find_symmetric_rotors();
  has_floating_base = links[0].joint == JointType::floating && dof_count[0] == 6;
  is_single_body = size == 1 && has_floating_base;
  find_gyrostat();
}

void TreeModel::find_gyrostat() {
  if (!has_floating_base || is_single_body) return;
  Gyrostat whole;
  whole.axial_inertia.assign(dofs, 0);
  for (std::size_t i = 0; i < links.size(); ++i) {
    const Link& link = links[i];
    if (i > 0 && (link.parent != 0 || !is_symmetric_rotor[first_dof[i]])) return;
    Vector3 place{0, 0, 0};
    Matrix3 rotation = Matrix3::Identity();
    if (i > 0) {
      rotation = joint_in_parent_rotation[i] * link_in_joint_rotation[i];
      place = link.joint_in_parent.position - rotation * link.joint_in_link.position;
      const Vector3 axis = link.joint_in_link.orientation * link.axis;
      whole.axial_inertia[first_dof[i]] = axis.dot(link.inertia.cwiseProduct(axis));
    }
    whole.inertia += inertia_about(link, rotation, place);
  }
  gyrostat = std::move(whole);
}

/// Lists the dofs between the root and each link.
void TreeModel::list_ancestor_dofs() {
  for (std::size_t i = 0; i < links.size(); ++i) {
    const auto begin = static_cast<std::ptrdiff_t>(ancestor_dofs.size());
    int carrier = static_cast<int>(i);
    while (carrier >= 0 && dof_count[carrier] == 0) carrier = links[carrier].parent;
    int k = carrier < 0 ? -1 : first_dof[carrier] + dof_count[carrier] - 1;
    for (; k >= 0; k = parent_dof[k]) ancestor_dofs.push_back(k);
    std::reverse(ancestor_dofs.begin() + begin, ancestor_dofs.end());
    ancestor_dofs_end.push_back(static_cast<int>(ancestor_dofs.size()));
  }
  dof_numbers.resize(dofs);
  std::iota(dof_numbers.begin(), dof_numbers.end(), 0);
}

void TreeModel::find_symmetric_rotors() {
  constexpr double rounding = 1e-9;
  is_symmetric_rotor.assign(dofs, 0);
  for (std::size_t i = 0; i < links.size(); ++i) {
    const Link& link = links[i];
    if (link.joint == JointType::revolute) {
      const Vector3 axis = link.joint_in_link.orientation * link.axis,
                    arm = link.joint_in_link.position;
      const Vector3 across = axis.unitOrthogonal(), other = axis.cross(across);
      const auto inertia = [&](const Vector3& a, const Vector3& b) {
        return a.dot(link.inertia.cwiseProduct(b));
      };
      const double most = rounding * link.inertia.maxCoeff();
      const bool round = std::abs(inertia(across, across) - inertia(other, other)) <= most &&
                         std::abs(inertia(across, other)) <= most &&
                         std::abs(inertia(axis, across)) <= most &&
                         std::abs(inertia(axis, other)) <= most;
      is_symmetric_rotor[first_dof[i]] =
          round && arm.cross(axis).norm() <= rounding * (1 + arm.norm());
    }
    int carrier = link.parent;
    while (carrier >= 0 && dof_count[carrier] == 0) carrier = links[carrier].parent;
    if (carrier >= 0 && dof_count[carrier] == 1) is_symmetric_rotor[first_dof[carrier]] = 0;
  }
}

Tree::Tree(std::vector<Link> with, const math::Pose& root, unsigned with_freedoms) {
  empty_model();  // so that clear() takes no memory
  use_model(std::make_shared<const TreeModel>(std::move(with), with_freedoms));
  reset_state();
  set_root(root);
  forward_kinematics(*this);
  velocity_kinematics(*this);
}

Tree::Tree(const Tree& like, const math::Pose& root) {
  use_model(like.model_);
  reset_state();
  set_root(root);
  forward_kinematics(*this);
  velocity_kinematics(*this);
}

void Tree::use_model(std::shared_ptr<const TreeModel> mechanism) noexcept {
  model_ = std::move(mechanism);
  const TreeModel& m = *model_;
  links = m.links;
  freedoms = m.freedoms;
  dofs = m.dofs;
  first_dof = m.first_dof;
  dof_count = m.dof_count;
  first_position = m.first_position;
  parent_dof = m.parent_dof;
  damping = m.damping;
  is_symmetric_rotor = m.is_symmetric_rotor;
  joint_in_parent_rotation = m.joint_in_parent_rotation;
  link_in_joint_rotation = m.link_in_joint_rotation;
  revolute = m.revolute;
  has_floating_base = m.has_floating_base;
  is_single_body = m.is_single_body;
  gyrostat = m.gyrostat ? &*m.gyrostat : nullptr;
}

bool Tree::share_model(const Tree& other) {
  const TreeModel &own = *model_, &its = *other.model_;
  if (own.freedoms != its.freedoms || own.links != its.links) return false;
  use_model(other.model_);
  return true;
}

/// Sets the state to rest, with memory for all results.
void Tree::reset_state() {
  const std::size_t size = links.size();
  q.assign(static_cast<std::size_t>(model_->position_count), 0);
  v.assign(static_cast<std::size_t>(dofs), 0);
  for (std::size_t i = 0; i < size; ++i) {
    if (links[i].joint == JointType::spherical) q[first_position[i]] = 1;
  }
  external.resize(size);
  external_at_sleep.resize(size);
  rotation.resize(size);
  position.resize(size);
  motion_subspace.resize(dofs);
  spatial_velocity.resize(size);
  int next = 0;  // the axes of a floating root never change
  for (int k = 0; k < 6 && links[0].joint == JointType::floating; ++k) {
    if (!(freedoms >> k & 1)) continue;
    Motion& axis = motion_subspace[next++];
    (k < 3 ? axis.angular : axis.linear)[k % 3] = 1;
  }
}

void Tree::clear() noexcept {
  use_model(empty_model());
  reset_state();
  set_root({});
  forward_kinematics(*this);
  velocity_kinematics(*this);
}

bool Tree::has_rotations() const {
  for (std::size_t i = 0; i < links.size(); ++i) {
    const bool is_root = links[i].joint == JointType::floating;
    if (!is_root && links[i].joint != JointType::spherical) continue;
    const double* turn = q.data() + first_position[i] + (is_root ? 3 : 0);
    if (!math::is_rotation({turn[0], turn[1], turn[2], turn[3]})) return false;
  }
  return true;
}

math::Pose Tree::pose(int link) const { return {position[link], Quaternion(rotation[link])}; }

void Tree::set_root(const math::Pose& pose) {
  fixed_root_ = pose;
  if (links[0].joint != JointType::floating) return;
  const Quaternion o = pose.orientation.normalized();
  q[0] = pose.position.x(), q[1] = pose.position.y(), q[2] = pose.position.z();
  q[3] = o.w(), q[4] = o.x(), q[5] = o.y(), q[6] = o.z();
}

Vector3 Tree::velocity(int link) const {
  return spatial_velocity[link].linear +
         spatial_velocity[link].angular.cross(position[link] - origin);
}

Vector3 Tree::angular_velocity(int link) const { return spatial_velocity[link].angular; }

void forward_kinematics(Tree& tree) {
  root_kinematics(tree, tree.fixed_root_);
  const int size = static_cast<int>(tree.links.size());
  for (int i = 1; i < size; ++i) {
    const Link& link = tree.links[i];
    const Matrix3& parent = tree.rotation[link.parent];
    const double* q = tree.q.data() + tree.first_position[i];
    Vector3 pivot = tree.position[link.parent] + parent * link.joint_in_parent.position;
    Motion* axes = tree.motion_subspace.data() + tree.first_dof[i];
    if (link.joint == JointType::revolute) {
      const RevoluteRotation& turn = tree.revolute[i];
      const Vector3 axis = parent * turn.axis;
      const Matrix3 in_parent =
          turn.constant + std::cos(q[0]) * turn.cosine + std::sin(q[0]) * turn.sine;
      axes[0] = {axis, (pivot - tree.origin).cross(axis)};
      tree.rotation[i].noalias() = parent * in_parent;
      tree.position[i] = pivot - tree.rotation[i] * link.joint_in_link.position;
      continue;
    }
    Matrix3 joint = parent * tree.joint_in_parent_rotation[i];
    if (link.joint == JointType::prismatic) {
      const Vector3 axis = joint * link.axis;
      pivot += axis * q[0];
      axes[0] = {Vector3::Zero(), axis};
    } else {
      joint = joint * rotation_matrix(q);
      for (int k = 0; k < 3; ++k) {
        axes[k] = {joint.col(k), (pivot - tree.origin).cross(joint.col(k))};
      }
    }
    tree.rotation[i] = joint * tree.link_in_joint_rotation[i];
    tree.position[i] = pivot - tree.rotation[i] * link.joint_in_link.position;
  }
}

void velocity_kinematics(Tree& tree) {
  const int size = static_cast<int>(tree.links.size());
  for (int i = 0; i < size; ++i) {
    Motion motion = i == 0 ? Motion{} : tree.spatial_velocity[tree.links[i].parent];
    const int first = tree.first_dof[i];
    for (int k = first; k < first + tree.dof_count[i]; ++k) {
      motion = motion + tree.motion_subspace[k] * tree.v[k];
    }
    tree.spatial_velocity[i] = motion;
  }
}

void prefetch(const Tree& tree) {
  prefetch(tree.q);
  prefetch(tree.v);
  prefetch(tree.external);
  prefetch(tree.rotation);
  prefetch(tree.position);
  prefetch(tree.motion_subspace);
  prefetch(tree.spatial_velocity);
}

void integrate_positions(Tree& tree, std::span<const double> step) {
  const int size = static_cast<int>(tree.links.size());
  for (int i = 0; i < size; ++i) {
    double* q = tree.q.data() + tree.first_position[i];
    const double* by = step.data() + tree.first_dof[i];
    switch (tree.links[i].joint) {
      case JointType::floating: {
        double all[6] = {};
        for (int k = 0, next = 0; k < 6; ++k) {
          if (tree.freedoms >> k & 1) all[k] = by[next++];
        }
        rotate_quaternion(q + 3, Vector3(all[0], all[1], all[2]), false);
        for (int k = 0; k < 3; ++k) q[k] += all[3 + k];
        break;
      }
      case JointType::fixed:
        break;
      case JointType::spherical:
        rotate_quaternion(q, Vector3(by[0], by[1], by[2]), true);
        break;
      default:
        q[0] += by[0];
    }
  }
}

double kinetic_energy(const Tree& tree) {
  double total = 0;
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    const Link& link = tree.links[i];
    if (link.joint == JointType::fixed) continue;
    const Vector3 omega = tree.rotation[i].transpose() * tree.spatial_velocity[i].angular;
    total += link.mass * tree.velocity(static_cast<int>(i)).squaredNorm() / 2;
    total += omega.cwiseProduct(link.inertia).dot(omega) / 2;
  }
  return total;
}

}  // namespace ziggurat::dynamics
