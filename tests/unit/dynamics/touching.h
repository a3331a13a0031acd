#pragma once
// Boxes that touch planes and each other: a small world for tests, with its own contact points.

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "dynamics/system.h"
#include "trees.h"

namespace ziggurat::dynamics::testing {

struct Plane {
  Vector3 point, normal;
  double friction = 1;
};

struct Touching {
  System system;
  std::vector<Vector3> half;      // of the box about each tree's last link [m]; 0: a point mass
  std::vector<double> friction;   // of each box; a contact has the product
  std::vector<Plane> planes;
  std::vector<Contact> contacts;
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
    find(length);
    const Report report = system.step(length, contacts, servos, limits);
    worst.not_converged += report.not_converged;
    worst.most_iterations = std::max(worst.most_iterations, report.most_iterations);
    worst.miss = std::max(worst.miss, report.miss);
    return report;
  }

  void find(double length) {
    std::vector<Contact> old;
    old.swap(contacts);
    for (int i = 0; i < static_cast<int>(half.size()); ++i) {
      for (const Plane& plane : planes) touch_plane(i, plane, length);
    }
    for (int i = 0; i < static_cast<int>(half.size()); ++i) {
      for (int j = i + 1; j < static_cast<int>(half.size()); ++j) touch_boxes(i, j, length);
    }
    for (Contact& contact : contacts) {
      double least = 25e-6;
      for (const Contact& other : old) {
        const double away = (other.point - contact.point).squaredNorm();
        const bool same = other.a.tree == contact.a.tree && other.b.tree == contact.b.tree &&
                          other.normal.dot(contact.normal) > 0.9;
        if (same && away < least) {
          least = away;
          contact.impulse = other.impulse;
        }
      }
    }
  }

  double reach(int i, double length) const {
    const Tree& t = system.trees[i];
    const int link = last_link(i);
    return 1e-3 + 15 * length * length +
           1.3 * length * (t.velocity(link).norm() + t.angular_velocity(link).norm() * half[i].norm());
  }

  Contact contact(int a, int b, const Vector3& point, const Vector3& normal, double gap, double mu) {
    Contact out;
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
    const Tree& t = system.trees[i];
    const math::Pose pose{t.position[last_link(i)], Quaternion(t.rotation[last_link(i)])};
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3 local(corner & 1 ? half[i].x() : -half[i].x(),
                          corner & 2 ? half[i].y() : -half[i].y(),
                          corner & 4 ? half[i].z() : -half[i].z());
      const Vector3 point = pose * local;
      const double gap = plane.normal.dot(point - plane.point);
      if (gap > reach(i, length)) continue;
      contacts.push_back(
          contact(i, -1, point - plane.normal * gap, plane.normal, gap, friction[i] * plane.friction));
    }
  }

  /// Box j on or beside box i: the face of i that looks most towards j carries it.
  void touch_boxes(int i, int j, double length) {
    const Tree &ti = system.trees[i], &tj = system.trees[j];
    const Vector3 between = tj.position[0] - ti.position[0];
    const double near = reach(i, length) + reach(j, length);
    if (between.norm() > half[i].norm() + half[j].norm() + near) return;
    const Matrix3 &ri = ti.rotation[0], &rj = tj.rotation[0];
    const Vector3 local = ri.transpose() * between;
    int axis = 0;
    for (int k = 1; k < 3; ++k) {
      const Vector3 e = half[i];
      if (std::abs(local[k]) - e[k] > std::abs(local[axis]) - e[axis]) axis = k;
    }
    const Vector3 normal = ri.col(axis) * (local[axis] < 0 ? -1.0 : 1.0);
    // The face of j that looks back most.
    int facing = 0;
    for (int k = 1; k < 3; ++k) {
      if (std::abs(rj.col(k).dot(normal)) > std::abs(rj.col(facing).dot(normal))) facing = k;
    }
    const double side = rj.col(facing).dot(normal) > 0 ? -1 : 1;
    const int u = (facing + 1) % 3, v = (facing + 2) % 3;
    std::vector<Vector3> polygon;
    for (const auto& [su, sv] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
      polygon.push_back(tj.position[0] + rj.col(facing) * side * half[j][facing] +
                        rj.col(u) * su * half[j][u] + rj.col(v) * sv * half[j][v]);
    }
    for (int k = 1; k <= 2; ++k) {
      const int across = (axis + k) % 3;
      for (const double sign : {-1.0, 1.0}) {
        clip(polygon, ri.col(across) * sign, ti.position[0], half[i][across]);
      }
    }
    for (const Vector3& point : polygon) {
      const double gap = normal.dot(point - ti.position[0]) - half[i][axis];
      if (gap < near) {
        contacts.push_back(contact(j, i, point - normal * gap, normal, gap, friction[i] * friction[j]));
      }
    }
  }

  static void clip(std::vector<Vector3>& polygon, const Vector3& out, const Vector3& centre,
                   double distance) {
    std::vector<Vector3> kept;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Vector3 &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
      const double dp = out.dot(p - centre) - distance, dq = out.dot(q - centre) - distance;
      if (dp <= 0) kept.push_back(p);
      if ((dp < 0) != (dq < 0) && dp != dq) kept.push_back(p + (q - p) * (dp / (dp - dq)));
    }
    polygon.swap(kept);
  }
};

inline math::Pose at(double x, double y, double z) {
  return {Vector3(x, y, z), Quaternion::Identity()};
}

}  // namespace ziggurat::dynamics::testing
