#include "dynamics/tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "dynamics/prefetch.h"
#include "dynamics/rotation.h"

namespace ziggurat::dynamics {
namespace {

int places_of(JointType joint) {
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

/// q := q turned by `turn`, on its right side (about the turned axes) or left (about the fixed).
void turn_quaternion(double* q, const Vector3& turn, bool right) {
  const Quaternion before(q[0], q[1], q[2], q[3]);
  const Quaternion by = exponential(turn);
  Quaternion after = right ? before * by : by * before;
  after.normalize();
  q[0] = after.w(), q[1] = after.x(), q[2] = after.y(), q[3] = after.z();
}

void place_root(Tree& tree, const math::Pose& fixed) {
  if (tree.links[0].joint == JointType::fixed) {
    tree.rotation[0] = fixed.orientation.toRotationMatrix();
    tree.position[0] = tree.origin = fixed.position;
    return;
  }
  const double* q = tree.q.data();
  tree.rotation[0] = rotation_matrix(q + 3);
  tree.position[0] = tree.origin = Vector3(q[0], q[1], q[2]);
}

/// Of trees that were taken apart.
const std::shared_ptr<const Mechanism>& nothing_that_moves() {
  static const auto mechanism = [] {
    std::vector<Link> links(1);
    links[0].joint = JointType::fixed;
    return std::make_shared<const Mechanism>(std::move(links), all_freedoms);
  }();
  return mechanism;
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

Mechanism::Mechanism(std::vector<Link> with, unsigned with_freedoms)
    : links(std::move(with)), freedoms(with_freedoms) {
  const std::size_t size = links.size();
  first_dof.resize(size);
  dof_count.resize(size);
  first_place.resize(size);
  for (std::size_t i = 0; i < size; ++i) {
    const Link& link = links[i];
    first_dof[i] = dofs;
    first_place[i] = places;
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
    places += places_of(link.joint);
    parent_side.push_back(link.joint_in_parent.orientation.toRotationMatrix());
    link_side.push_back(link.joint_in_link.orientation.conjugate().toRotationMatrix());
  }
  note_ways();
  note_spinning();
  free_root = links[0].joint == JointType::floating && dof_count[0] == 6;
  single = size == 1 && free_root;
}

/// The dofs on the way to each link.
void Mechanism::note_ways() {
  for (std::size_t i = 0; i < links.size(); ++i) {
    const auto begin = static_cast<std::ptrdiff_t>(ways.size());
    int carrier = static_cast<int>(i);
    while (carrier >= 0 && dof_count[carrier] == 0) carrier = links[carrier].parent;
    int k = carrier < 0 ? -1 : first_dof[carrier] + dof_count[carrier] - 1;
    for (; k >= 0; k = parent_dof[k]) ways.push_back(k);
    std::reverse(ways.begin() + begin, ways.end());
    way_end.push_back(static_cast<int>(ways.size()));
  }
  dof_places.resize(dofs);
  std::iota(dof_places.begin(), dof_places.end(), 0);
}

void Mechanism::note_spinning() {
  constexpr double rounding = 1e-9;
  spins.assign(dofs, 0);
  for (std::size_t i = 0; i < links.size(); ++i) {
    const Link& link = links[i];
    if (link.joint == JointType::revolute) {
      const Vector3 axis = link.joint_in_link.orientation * link.axis, arm = link.joint_in_link.position;
      const Vector3 across = axis.unitOrthogonal(), other = axis.cross(across);
      const auto inertia = [&](const Vector3& a, const Vector3& b) { return a.dot(link.inertia.cwiseProduct(b)); };
      const double most = rounding * link.inertia.maxCoeff();
      const bool round = std::abs(inertia(across, across) - inertia(other, other)) <= most && std::abs(inertia(across, other)) <= most &&
                         std::abs(inertia(axis, across)) <= most && std::abs(inertia(axis, other)) <= most;
      spins[first_dof[i]] = round && arm.cross(axis).norm() <= rounding * (1 + arm.norm());
    }
    int carrier = link.parent;
    while (carrier >= 0 && dof_count[carrier] == 0) carrier = links[carrier].parent;
    if (carrier >= 0 && dof_count[carrier] == 1) spins[first_dof[carrier]] = 0;
  }
}

Tree::Tree(std::vector<Link> with, const math::Pose& root, unsigned with_freedoms) {
  nothing_that_moves();  // so that take_apart() takes no memory
  use(std::make_shared<const Mechanism>(std::move(with), with_freedoms));
  begin();
  set_root(root);
  place(*this);
  move(*this);
}

Tree::Tree(const Tree& like, const math::Pose& root) {
  use(like.mechanism_);
  begin();
  set_root(root);
  place(*this);
  move(*this);
}

void Tree::use(std::shared_ptr<const Mechanism> mechanism) noexcept {
  mechanism_ = std::move(mechanism);
  const Mechanism& m = *mechanism_;
  links = m.links;
  freedoms = m.freedoms;
  dofs = m.dofs;
  first_dof = m.first_dof;
  dof_count = m.dof_count;
  first_place = m.first_place;
  parent_dof = m.parent_dof;
  damping = m.damping;
  spins = m.spins;
  parent_side = m.parent_side;
  link_side = m.link_side;
  free_root = m.free_root;
  single = m.single;
}

bool Tree::share(const Tree& other) {
  const Mechanism &own = *mechanism_, &its = *other.mechanism_;
  if (own.freedoms != its.freedoms || own.links != its.links) return false;
  use(other.mechanism_);
  return true;
}

/// The state at rest, with memory for what follows from it.
void Tree::begin() {
  const std::size_t size = links.size();
  q.assign(static_cast<std::size_t>(mechanism_->places), 0);
  v.assign(static_cast<std::size_t>(dofs), 0);
  for (std::size_t i = 0; i < size; ++i) {
    if (links[i].joint == JointType::spherical) q[first_place[i]] = 1;
  }
  external.resize(size);
  held_by.resize(size);
  rotation.resize(size);
  position.resize(size);
  axes.resize(dofs);
  motion.resize(size);
  int next = 0;  // the axes of a floating root never change
  for (int k = 0; k < 6 && links[0].joint == JointType::floating; ++k) {
    if (!(freedoms >> k & 1)) continue;
    Motion& axis = axes[next++];
    (k < 3 ? axis.angular : axis.linear)[k % 3] = 1;
  }
}

void Tree::take_apart() noexcept {
  use(nothing_that_moves());
  begin();
  set_root({});
  place(*this);
  move(*this);
}

bool Tree::has_rotations() const {
  for (std::size_t i = 0; i < links.size(); ++i) {
    const bool is_root = links[i].joint == JointType::floating;
    if (!is_root && links[i].joint != JointType::spherical) continue;
    const double* turn = q.data() + first_place[i] + (is_root ? 3 : 0);
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
  return motion[link].linear + motion[link].angular.cross(position[link] - origin);
}

Vector3 Tree::angular_velocity(int link) const { return motion[link].angular; }

void place(Tree& tree) {
  place_root(tree, tree.fixed_root_);
  const int size = static_cast<int>(tree.links.size());
  for (int i = 1; i < size; ++i) {
    const Link& link = tree.links[i];
    const Matrix3& parent = tree.rotation[link.parent];
    const double* q = tree.q.data() + tree.first_place[i];
    Matrix3 joint = parent * tree.parent_side[i];
    Vector3 pivot = tree.position[link.parent] + parent * link.joint_in_parent.position;
    Motion* axes = tree.axes.data() + tree.first_dof[i];
    if (link.joint == JointType::revolute) {
      const Vector3 axis = joint * link.axis;
      joint = joint * rotation_about(link.axis, q[0]);
      axes[0] = {axis, (pivot - tree.origin).cross(axis)};
    } else if (link.joint == JointType::prismatic) {
      const Vector3 axis = joint * link.axis;
      pivot += axis * q[0];
      axes[0] = {Vector3::Zero(), axis};
    } else {
      joint = joint * rotation_matrix(q);
      for (int k = 0; k < 3; ++k) {
        axes[k] = {joint.col(k), (pivot - tree.origin).cross(joint.col(k))};
      }
    }
    tree.rotation[i] = joint * tree.link_side[i];
    tree.position[i] = pivot - tree.rotation[i] * link.joint_in_link.position;
  }
}

void move(Tree& tree) {
  const int size = static_cast<int>(tree.links.size());
  for (int i = 0; i < size; ++i) {
    Motion motion = i == 0 ? Motion{} : tree.motion[tree.links[i].parent];
    const int first = tree.first_dof[i];
    for (int k = first; k < first + tree.dof_count[i]; ++k) {
      motion = motion + tree.axes[k] * tree.v[k];
    }
    tree.motion[i] = motion;
  }
}

void fetch(const Tree& tree) {
  fetch(tree.q);
  fetch(tree.v);
  fetch(tree.external);
  fetch(tree.rotation);
  fetch(tree.position);
  fetch(tree.axes);
  fetch(tree.motion);
}

void displace(Tree& tree, std::span<const double> step) {
  const int size = static_cast<int>(tree.links.size());
  for (int i = 0; i < size; ++i) {
    double* q = tree.q.data() + tree.first_place[i];
    const double* by = step.data() + tree.first_dof[i];
    switch (tree.links[i].joint) {
      case JointType::floating: {
        double all[6] = {};
        for (int k = 0, next = 0; k < 6; ++k) {
          if (tree.freedoms >> k & 1) all[k] = by[next++];
        }
        turn_quaternion(q + 3, Vector3(all[0], all[1], all[2]), false);
        for (int k = 0; k < 3; ++k) q[k] += all[3 + k];
        break;
      }
      case JointType::fixed:
        break;
      case JointType::spherical:
        turn_quaternion(q, Vector3(by[0], by[1], by[2]), true);
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
    const Vector3 omega = tree.rotation[i].transpose() * tree.motion[i].angular;
    total += link.mass * tree.velocity(static_cast<int>(i)).squaredNorm() / 2;
    total += omega.cwiseProduct(link.inertia).dot(omega) / 2;
  }
  return total;
}

}  // namespace ziggurat::dynamics
