// SPDX-License-Identifier: MIT
#pragma once
// Boxes that touch planes and each other: a small world for tests, with its own contact points.

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "box_contacts.h"
#include "physics/stepping/system.h"
#include "step_with_impacts.h"
#include "trees.h"

namespace ziggurat::dynamics::testing {

struct Plane {
  Vector3 point, normal;
  double friction = 1;
};

struct Touching {
  System system;
  std::vector<Vector3> half;     // of the box about each tree's last link [m]; 0: a point mass
  std::vector<double> friction;  // of each box; a contact has the product
  std::vector<Plane> planes;
  std::vector<ContactPoint> contacts;
  std::vector<Servo> servos;
  std::vector<Limit> limits;
  double restitution = 0;
  Vector3 gravity{0, 0, -g};
  Report worst;

  int add(Tree tree, const Vector3& half_sides, double mu) {
    system.trees.push_back(std::move(tree));
    half.push_back(half_sides);
    friction.push_back(mu);
    return static_cast<int>(half.size()) - 1;
  }
  int add_box(const Vector3& sides, double mass, const math::Pose& pose, double mu) {
    return add(box(sides, mass, pose), sides / 2, mu);
  }
  Tree& tree(int i) { return system.trees[i]; }
  int last_link(int i) const { return static_cast<int>(system.trees[i].links.size()) - 1; }

  Report step(double length) {
    for (Tree& each : system.trees) each.gravity = gravity;
    const Report report = step_with_impacts(system, length, contacts, servos, limits,
                                            [&](double time) { find(time); });
    worst.not_converged += report.not_converged;
    worst.most_iterations = std::max(worst.most_iterations, report.most_iterations);
    worst.residual = std::max(worst.residual, report.residual);
    return report;
  }

  void find(double length) {
    std::vector<ContactPoint> old;
    old.swap(contacts);
    for (int i = 0; i < static_cast<int>(half.size()); ++i) {
      for (const Plane& plane : planes) touch_plane(i, plane, length);
    }
    for (int i = 0; i < static_cast<int>(half.size()); ++i) {
      for (int j = i + 1; j < static_cast<int>(half.size()); ++j) touch_pair(i, j, length);
    }
    remember(old);
  }

  /// Impulses of the last substep for points of the same pair nearby.
  void remember(const std::vector<ContactPoint>& old) {
    std::map<std::pair<int, int>, std::size_t> first;
    for (std::size_t k = old.size(); k-- > 0;) first[{old[k].a.tree, old[k].b.tree}] = k;
    for (ContactPoint& contact : contacts) {
      const auto found = first.find({contact.a.tree, contact.b.tree});
      if (found == first.end()) continue;
      double least = 25e-6;
      for (std::size_t k = found->second; k < old.size(); ++k) {
        const ContactPoint& other = old[k];
        if (other.a.tree != contact.a.tree || other.b.tree != contact.b.tree) break;
        const double away = (other.point - contact.point).squaredNorm();
        if (other.normal.dot(contact.normal) > 0.9 && away < least) {
          least = away;
          contact.impulse = other.impulse;
          contact.carried = !other.impulse.isZero(0);
        }
      }
    }
  }

  /// Largest approach of tree i to tree j (-1: the world) within a substep.
  double reach(int i, int j, double length) const {
    const auto linear = [&](int k) -> Vector3 {
      return k < 0 ? Vector3::Zero() : system.trees[k].velocity(last_link(k));
    };
    const auto turning = [&](int k) {
      return k < 0 ? 0.0 : system.trees[k].angular_velocity(last_link(k)).norm() * half[k].norm();
    };
    return 1e-3 + 15 * length * length +
           1.3 * length * ((linear(i) - linear(j)).norm() + turning(i) + turning(j));
  }

  ContactPoint contact(int a, int b, const Vector3& point, const Vector3& normal, double gap,
                       double mu) {
    ContactPoint out;
    out.a = {a, a < 0 ? 0 : last_link(a)};
    out.b = {b, b < 0 ? 0 : last_link(b)};
    out.point = point;
    out.normal = normal;
    out.gap = gap;
    out.friction = mu;
    out.restitution = restitution;
    return out;
  }

  void touch_plane(int i, const Plane& plane, double length) {
    const OrientedBox box = shape(i);
    const double near = reach(i, -1, length);
    if (plane.normal.dot(box.centre - plane.point) > box.half.norm() + near) return;
    points_.clear();
    for (const Vector3& point : face_towards(box, -plane.normal)) {
      const double gap = plane.normal.dot(point - plane.point);
      if (gap < near) points_.push_back({point - plane.normal * gap, plane.normal, gap});
    }
    for (const BoxPoint& p : points_) {
      contacts.push_back(contact(i, -1, p.point, p.normal, p.gap, friction[i] * plane.friction));
    }
  }

  OrientedBox shape(int i) const {
    const Tree& t = system.trees[i];
    return {t.position[last_link(i)], t.rotation[last_link(i)], half[i]};
  }

  void touch_pair(int i, int j, double length) {
    const double near = reach(i, j, length), radii = half[i].norm() + half[j].norm() + near;
    const Vector3 between = tree(i).position[last_link(i)] - tree(j).position[last_link(j)];
    if (between.squaredNorm() > radii * radii) return;
    points_.clear();
    touch_boxes(shape(j), shape(i), near, points_);
    for (const BoxPoint& p : points_) {
      contacts.push_back(contact(j, i, p.point, p.normal, p.gap, friction[i] * friction[j]));
    }
  }

 private:
  std::vector<BoxPoint> points_;
};

inline math::Pose at(double x, double y, double z) {
  return {Vector3(x, y, z), Quaternion::Identity()};
}

}  // namespace ziggurat::dynamics::testing
