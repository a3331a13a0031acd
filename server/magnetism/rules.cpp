// SPDX-License-Identifier: MIT
#include "magnetism/rules.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace ziggurat::magnetism {
namespace {

void add(Rule& rule, const Vector3& point, double weight) {
  rule.points.push_back(point);
  rule.weights.push_back(weight);
  rule.centre_weight -= weight;
}

/// Both points where only one coordinate is not zero.
void add_axis(Rule& rule, int axis, double distance, double weight) {
  add(rule, distance * Vector3::Unit(axis), weight);
  add(rule, -distance * Vector3::Unit(axis), weight);
}

void add_corners(Rule& rule, const Vector3& corner, double weight) {
  for (int k = 0; k < 8; ++k) {
    add(rule,
        {k & 1 ? corner.x() : -corner.x(), k & 2 ? corner.y() : -corner.y(),
         k & 4 ? corner.z() : -corner.z()},
        weight);
  }
}

/// Mean of the square of each coordinate [m^2].
Vector3 second_moments(const Shape& shape) {
  if (const auto* box = std::get_if<Box>(&shape)) return box->size.cwiseAbs2() / 12;
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    const double across = cylinder->radius * cylinder->radius / 4;
    return {across, across, cylinder->height * cylinder->height / 12};
  }
  return Vector3::Zero();
}

bool is_cube(const Box& box) {
  return box.size.maxCoeff() - box.size.minCoeff() < 1e-6 * box.size.maxCoeff();
}

/// Rule with a ring of six, two points on the axis and the centre. Its two weights give the moments
/// of orders 2 and 4 of the cylinder:
///
///   x - y / 2 = M_2,   x a^2 + 3/8 y b^2 = M_4,   x = 2 w_axis a^2,  y = 6 w_ring b^2,
///
///   M_2 = <z^2> - <r^2>/2,   M_4 = <z^4> - 3 <z^2><r^2> + 3/8 <r^4>.
Rule fine_cylinder(const Cylinder& cylinder) {
  const double r2 = cylinder.radius * cylinder.radius;
  const double t2 = cylinder.height * cylinder.height;
  const double second = t2 / 12 - r2 / 4;
  const double fourth = t2 * t2 / 80 - 3 * (t2 / 12) * (r2 / 2) + r2 * r2 / 8;
  const double a2 = 0.15 * t2;   // as in the three-point Gauss rule
  const double b2 = r2 * 2 / 3;  // as in the seven-point rule of the disc
  const double y = (fourth - second * a2) / (a2 / 2 + 3 * b2 / 8);
  const double x = second + y / 2;
  Rule rule;
  add_axis(rule, 2, std::sqrt(a2), x / a2 / 2);
  const double b = std::sqrt(b2);
  const double half_root = std::sqrt(0.75);
  for (const double side : {1.0, -1.0}) {
    add(rule, {side * b, 0, 0}, y / b2 / 6);
    add(rule, {side * b / 2, side * b * half_root, 0}, y / b2 / 6);
    add(rule, {side * b / 2, -side * b * half_root, 0}, y / b2 / 6);
  }
  return rule;
}

/// Nodes and weights of the five-point Gauss rule on [-1, 1].
constexpr double gauss_nodes[] = {0, 0.5384693101056831, -0.5384693101056831, 0.9061798459386640,
                                  -0.9061798459386640};
constexpr double gauss_weights[] = {0.5688888888888889, 0.4786286704993665, 0.4786286704993665,
                                    0.2369268850561891, 0.2369268850561891};

/// Exact for the moments asked for here.
Rule full_rule(const Shape& shape) {
  Rule rule;
  if (const auto* box = std::get_if<Box>(&shape)) {
    for (int i = 0; i < 125; ++i) {
      const int n[] = {i % 5, i / 5 % 5, i / 25};
      const Vector3 at(gauss_nodes[n[0]], gauss_nodes[n[1]], gauss_nodes[n[2]]);
      add(rule, at.cwiseProduct(box->size) / 2,
          gauss_weights[n[0]] * gauss_weights[n[1]] * gauss_weights[n[2]] / 8);
    }
  } else if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    for (int i = 0; i < 25; ++i) {
      const double radius = cylinder->radius * std::sqrt((1 + gauss_nodes[i / 5]) / 2);
      const double z = gauss_nodes[i % 5] * cylinder->height / 2;
      for (int k = 0; k < 12; ++k) {
        const double angle = 2 * pi * k / 12;
        add(rule, {radius * std::cos(angle), radius * std::sin(angle), z},
            gauss_weights[i / 5] * gauss_weights[i % 5] / 48);
      }
    }
  }
  return rule;
}

/// Directions of one octant; the shapes and rules are the same in all.
constexpr int directions = 26;

using MomentTable = std::array<Moments, directions>;

/// Moments of even orders along every direction, Legendre's polynomials by their recurrence.
MomentTable table(const Rule& rule) {
  MomentTable result{};
  for (int d = 0; d < directions; ++d) {
    const int code = d + 1;
    const Vector3 direction = Vector3(code % 3, code / 3 % 3, code / 9).normalized();
    result[d][0] = rule.centre_weight;
    for (std::size_t k = 0; k < rule.points.size(); ++k) {
      // r^l P_l(x / r) = R_l:  (l + 1) R_{l+1} = (2 l + 1) x R_l - l r^2 R_{l-1}.
      const double along = rule.points[k].dot(direction);
      const double squared = rule.points[k].squaredNorm();
      double before = 1;
      double now = along;
      for (int l = 0; l <= 8; ++l) {
        if (l % 2 == 0) result[d][l / 2] += rule.weights[k] * before;
        const double next = ((2 * l + 3) * along * now - (l + 1) * squared * before) / (l + 2);
        before = now;
        now = next;
      }
    }
  }
  return result;
}

/// Largest over directions of the difference of two rules' moments.
Moments difference(const MomentTable& a, const MomentTable& b) {
  Moments result{};
  for (int d = 0; d < directions; ++d) {
    for (std::size_t half = 0; half < result.size(); ++half) {
      result[half] = std::max(result[half], std::fabs(a[d][half] - b[d][half]));
    }
  }
  return result;
}

/// Ratio of the worst error over orientations, and of the torque, to that of the coaxial force. It
/// grows with the distance in sides, since the torque is measured by the side. Measured over random
/// poses (docs/magnetism.md).
double orientation_factor(double distance, double side) {
  return std::clamp(0.45 * distance / side, 2.3, 3.5);
}
/// The same where only products of errors are left: cubes, and shapes with second moments.
constexpr double mixed_factors[] = {1.5, 2.7};

/// Relative error of the coaxial force at distance 1, from the product of two moments. The moment
/// of order l is wrong; the other one has order m:
///
///    C(l+m, m) (l+m+1)(l+m+2)(l+m+3) / 6.
double amplification(int l, int m) {
  const double n = l + m;
  double binomial = 1;
  for (int k = 1; k <= m; ++k) binomial *= (n - m + k) / k;
  return binomial * (n + 1) * (n + 2) * (n + 3) / 6;
}

double error(const Moments& wrong, const Moments& other, double distance) {
  double sum = 0;
  for (int l = 2; l <= 8; l += 2) {
    for (int m = 0; m + l <= 10; m += 2) {
      if (m > 8) continue;
      sum += amplification(l, m) * wrong[l / 2] * (m == 0 ? 1 : other[m / 2]) /
             std::pow(distance, l + m);
    }
  }
  return sum;
}

/// The least distance, not below the bound, from which on the error stays within the tolerance.
double least_distance(double bound, double tolerance, const std::function<double(double)>& error) {
  double low = bound;
  if (error(low) <= tolerance) return low;
  double high = 2 * bound;
  while (error(high) > tolerance) high *= 2;
  for (int k = 0; k < 40; ++k) {
    const double middle = (low + high) / 2;
    (error(middle) <= tolerance ? high : low) = middle;
  }
  return high;
}

}  // namespace

Rule point_rule() { return {}; }

Rule coarse_rule(const Shape& shape) {
  const Vector3 second = second_moments(shape);
  const double least = second.minCoeff();
  Rule rule;
  if (std::holds_alternative<Cylinder>(shape) && second.z() == least) {
    const double excess = second.x() - least;
    if (excess > 1e-4 * second.x()) {
      for (int axis = 0; axis < 2; ++axis) add_axis(rule, axis, std::sqrt(2 * excess), 0.25);
    }
    return rule;
  }
  std::vector<Vector3> points = {Vector3::Zero()};
  for (int axis = 0; axis < 3; ++axis) {
    const double excess = second[axis] - least;
    if (excess <= 1e-4 * second[axis]) continue;
    const std::size_t count = points.size();
    for (std::size_t k = 0; k < count; ++k) {
      points.push_back(points[k] - std::sqrt(excess) * Vector3::Unit(axis));
      points[k] += std::sqrt(excess) * Vector3::Unit(axis);
    }
  }
  if (points.size() == 1) return rule;
  for (const Vector3& point : points) add(rule, point, 1 / static_cast<double>(points.size()));
  return rule;
}

Rule fine_rule(const Shape& shape) {
  Rule rule;
  if (const auto* box = std::get_if<Box>(&shape)) {
    if (is_cube(*box)) {
      // Eight corners and the centre share the cubic moments of orders 4 and 6: with half side 1,
      // W b^4 = 1/15 and W b^6 = 0.015872 (docs/magnetism.md).
      const double b = 0.487929;
      add_corners(rule, b * box->size / 2, 1 / (15 * b * b * b * b) / 8);
    } else {
      // Hammer and Stroud's 14 points for the box, exact to the fifth degree.
      for (int axis = 0; axis < 3; ++axis) {
        add_axis(rule, axis, std::sqrt(19.0 / 30) * box->size[axis] / 2, 40.0 / 361);
      }
      add_corners(rule, std::sqrt(19.0 / 33) * box->size / 2, 121.0 / 361 / 8);
      rule.centre_weight = 0;
    }
  } else if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    return fine_cylinder(*cylinder);
  }
  return rule;
}

Moments moments(const Shape& shape) {
  Moments result = difference(table(full_rule(shape)), table(point_rule()));
  result[0] = 1;
  return result;
}

Moments residual(const Rule& rule, const Shape& shape) {
  return difference(table(rule), table(full_rule(shape)));
}

Reach reach(const Shape& shape, double tolerance) {
  const double size = bounding_radius(shape);
  if (std::holds_alternative<PointShape>(shape) || std::holds_alternative<Sphere>(shape)) return {};
  const Moments body = moments(shape);
  const Moments point = residual(point_rule(), shape);
  const Moments coarse = residual(coarse_rule(shape), shape);
  const Moments fine = residual(fine_rule(shape), shape);
  const auto both = [&](const Moments& wrong) {
    return [&](double d) {
      return 2 * orientation_factor(d, longest_side(shape)) * error(wrong, body, d);
    };
  };
  // Error of the mixed form: products of the parts that both points get wrong.
  const auto mixed = [&](double d) {
    double both_wrong = 0;
    for (int l = 2; l <= 8; l += 2) {
      for (int m = 2; m <= 8; m += 2) {
        both_wrong += amplification(l, m) * point[l / 2] * point[m / 2] / std::pow(d, l + m);
      }
    }
    return mixed_factors[coarse_rule(shape).points.empty() ? 0 : 1] *
           (2 * error(fine, Moments{}, d) + both_wrong);
  };
  const double bound = size;
  return {least_distance(bound, tolerance, both(point)),
          least_distance(bound, tolerance, both(coarse)), least_distance(bound, tolerance, mixed),
          least_distance(bound, tolerance, both(fine))};
}

}  // namespace ziggurat::magnetism
