// SPDX-License-Identifier: MIT
#pragma once
// Contact points of two boxes: the axis of least overlap among the 15 that can separate them (S.
// Gottschalk, M. C. Lin, D. Manocha, SIGGRAPH 1996). Then the incident face is clipped by the sides
// of the reference face, or two edges have their nearest points; at most four points.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "physics/multibody/spatial.h"

namespace ziggurat::dynamics::testing {

struct OrientedBox {
  Vector3 centre;  ///< [m]
  Matrix3 axes;
  Vector3 half;  ///< [m]
};

struct BoxPoint {
  Vector3 point;   ///< on b [m]
  Vector3 normal;  ///< from b to a
  double gap;      ///< [m]
};

/// Keeps four points: the deepest, the one farthest from it, and the two that add most area on
/// either side.
inline void keep_four(std::vector<BoxPoint>& points) {
  if (points.size() <= 4) return;
  const auto deepest = std::min_element(points.begin(), points.end(),
                                        [](const auto& a, const auto& b) { return a.gap < b.gap; });
  std::swap(*deepest, points[0]);
  const Vector3 first = points[0].point, normal = points[0].normal;
  const auto farthest =
      std::max_element(points.begin() + 1, points.end(), [&](const BoxPoint& a, const BoxPoint& b) {
        return (a.point - first).squaredNorm() < (b.point - first).squaredNorm();
      });
  std::swap(*farthest, points[1]);
  const Vector3 across = normal.cross(points[1].point - first);
  const auto side = [&](const BoxPoint& p) { return across.dot(p.point - first); };
  const auto less = [&](const BoxPoint& a, const BoxPoint& b) { return side(a) < side(b); };
  std::swap(*std::min_element(points.begin() + 2, points.end(), less), points[2]);
  std::swap(*std::max_element(points.begin() + 3, points.end(), less), points[3]);
  points.resize(4);
}

/// Drops what is beyond a plane.
inline void clip(std::vector<Vector3>& polygon, const Vector3& out, double bound) {
  std::vector<Vector3> kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vector3 &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
    const double dp = out.dot(p) - bound, dq = out.dot(q) - bound;
    if (dp <= 0) kept.push_back(p);
    if ((dp < 0) != (dq < 0) && dp != dq) kept.push_back(p + (q - p) * (dp / (dp - dq)));
  }
  polygon.swap(kept);
}

/// The corners of the face of a box whose outward normal looks most along a direction.
inline std::vector<Vector3> face_towards(const OrientedBox& box, const Vector3& direction) {
  const Vector3 local = box.axes.transpose() * direction;
  int facing = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::abs(local[k]) > std::abs(local[facing])) facing = k;
  }
  const double side = local[facing] > 0 ? 1 : -1;
  const int u = (facing + 1) % 3, v = (facing + 2) % 3;
  std::vector<Vector3> out;
  for (const auto& [su, sv] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
    out.push_back(box.centre + box.axes.col(facing) * (side * box.half[facing]) +
                  box.axes.col(u) * (su * box.half[u]) + box.axes.col(v) * (sv * box.half[v]));
  }
  return out;
}

/// Points of a face of `reference`, whose outward normal is `out`, and what of `other` is nearer
/// than `reach`.
/// @param flip  the reference is a
inline void face_points(const OrientedBox& reference, int axis, const Vector3& out,
                        const OrientedBox& other, double reach, bool flip,
                        std::vector<BoxPoint>& points) {
  std::vector<Vector3> polygon = face_towards(other, -out);
  for (int k = 1; k <= 2; ++k) {
    const int across = (axis + k) % 3;
    for (const double sign : {-1.0, 1.0}) {
      const Vector3 side = reference.axes.col(across) * sign;
      clip(polygon, side, side.dot(reference.centre) + reference.half[across]);
    }
  }
  const double level = out.dot(reference.centre) + reference.half[axis];
  for (const Vector3& corner : polygon) {
    const double gap = out.dot(corner) - level;
    if (gap < reach) {
      points.push_back(
          {flip ? corner : Vector3(corner - out * gap), flip ? Vector3(-out) : out, gap});
    }
  }
}

/// Appends the points where a and b are nearer than `reach`.
inline void touch_boxes(const OrientedBox& a, const OrientedBox& b, double reach,
                        std::vector<BoxPoint>& points) {
  const Vector3 between = a.centre - b.centre;
  const double radii = a.half.norm() + b.half.norm() + reach;
  if (between.squaredNorm() > radii * radii) return;
  const auto radius = [](const OrientedBox& box, const Vector3& axis) {
    return (box.axes.transpose() * axis).cwiseAbs().dot(box.half);
  };
  double best = -std::numeric_limits<double>::infinity();
  int best_axis = -1;
  Vector3 best_normal;
  for (int k = 0; k < 15; ++k) {
    Vector3 axis;
    if (k < 6) {
      axis = k < 3 ? b.axes.col(k) : a.axes.col(k - 3);
    } else {
      axis = a.axes.col((k - 6) / 3).cross(b.axes.col((k - 6) % 3));
      const double length = axis.norm();
      if (length < 1e-3) continue;
      axis /= length;
    }
    if (axis.dot(between) < 0) axis = -axis;
    const double gap = axis.dot(between) - radius(a, axis) - radius(b, axis);
    if (gap > reach) return;
    const double bias = k < 3 ? 0 : k < 6 ? 1e-6 : 1e-4 + 0.05 * std::abs(gap);  // faces first
    if (gap - bias > best) best = gap - bias, best_axis = k, best_normal = axis;
  }
  const std::size_t before = points.size();
  std::vector<BoxPoint> found;
  if (best_axis < 3) {
    face_points(b, best_axis, best_normal, a, reach, false, found);
  } else if (best_axis < 6) {
    face_points(a, best_axis - 3, -best_normal, b, reach, true, found);
  } else {
    const int ka = (best_axis - 6) / 3, kb = (best_axis - 6) % 3;
    Vector3 on_a = a.centre, on_b = b.centre;  // middles of the edges
    for (int k = 0; k < 3; ++k) {
      if (k != ka)
        on_a -= a.axes.col(k) * (a.axes.col(k).dot(best_normal) > 0 ? 1 : -1) * a.half[k];
      if (k != kb)
        on_b += b.axes.col(k) * (b.axes.col(k).dot(best_normal) > 0 ? 1 : -1) * b.half[k];
    }
    const Vector3 da = a.axes.col(ka), db = b.axes.col(kb), d = on_a - on_b;
    const double c = da.dot(db), s = 1 - c * c;
    const double t = (da.dot(d) - c * db.dot(d)) / -s, w = (db.dot(d) - c * da.dot(d)) / s;
    on_a += da * std::clamp(t, -a.half[ka], a.half[ka]);
    on_b += db * std::clamp(w, -b.half[kb], b.half[kb]);
    found.push_back({on_b, best_normal, best_normal.dot(on_a - on_b)});
  }
  keep_four(found);
  points.insert(points.begin() + static_cast<std::ptrdiff_t>(before), found.begin(), found.end());
}

}  // namespace ziggurat::dynamics::testing
