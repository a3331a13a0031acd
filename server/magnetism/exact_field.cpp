// SPDX-License-Identifier: MIT
#include "magnetism/exact_field.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "magnetism/elementary.h"

namespace ziggurat::magnetism {
namespace {

/// The eight corners as seen from a point, along three axes that are some permutation of x, y, z.
struct Corners {
  double u[2], v[2], w[2];  // coordinate of the point minus that of the lower, upper corner [m]
};

/// Sum over corners of +- ln(r + w).
double sum_of_logarithms(const Corners& c) {
  double above = 1;
  double below = 1;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      const double across = std::max(c.u[i] * c.u[i] + c.v[j] * c.v[j], 1e-40);
      // ln(r1 + w1) - ln(r0 + w0); r + w = across / (r - w) where w < 0 would cancel.
      double upper = 1;
      double lower = 1;
      const double r0 = std::sqrt(across + c.w[0] * c.w[0]);
      const double r1 = std::sqrt(across + c.w[1] * c.w[1]);
      if (c.w[0] < 0 && c.w[1] < 0) {
        upper = r0 - c.w[0];
        lower = r1 - c.w[1];
      } else {
        upper = c.w[1] < 0 ? across / (r1 - c.w[1]) : r1 + c.w[1];
        lower = c.w[0] < 0 ? across / (r0 - c.w[0]) : r0 + c.w[0];
      }
      (i == j ? above : below) *= upper;
      (i == j ? below : above) *= lower;
    }
  }
  return logarithm(above / below);
}

/// Sum over corners of +- atan(u v / (w r)).
double sum_of_angles(const Corners& c) {
  double sum = 0;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      double numerators[2];
      double denominators[2];
      for (int k = 0; k < 2; ++k) {
        const double r = std::sqrt(c.u[i] * c.u[i] + c.v[j] * c.v[j] + c.w[k] * c.w[k]);
        const double sign = c.w[k] < 0 ? -1 : 1;
        numerators[k] = sign * c.u[i] * c.v[j];
        denominators[k] = sign * c.w[k] * r;
      }
      const double difference =
          angle(numerators[1] * denominators[0] - numerators[0] * denominators[1],
                denominators[1] * denominators[0] + numerators[1] * numerators[0]);
      sum += i == j ? difference : -difference;
    }
  }
  return sum;
}

constexpr std::size_t most_nodes = 512;

/// Cosines and sines of most_nodes equal steps around the circle, from square roots alone.
struct Circle {
  std::array<double, most_nodes> cosine, sine;

  Circle() {
    cosine[0] = 1;
    sine[0] = 0;
    double c = -1;  // of half a turn, halved again and again
    double s = 0;
    for (std::size_t step = most_nodes / 2; step >= 1; step /= 2) {
      for (std::size_t k = 0; k < most_nodes; k += 2 * step) {
        cosine[k + step] = cosine[k] * c - sine[k] * s;
        sine[k + step] = sine[k] * c + cosine[k] * s;
      }
      const double next = std::sqrt((1 + c) / 2);
      s = c == -1 ? 1 : s / (2 * next);
      c = next;
    }
  }
};

const Circle& circle() {
  static const Circle table;
  return table;
}

/// Nodes for e^(-n eta) <= tolerance, where eta is the distance of the integrand's nearest
/// singularity from the real axis.
std::size_t nodes_needed(const Cylinder& cylinder, double radius, double z, double tolerance) {
  const double beyond = std::max(std::fabs(z) - cylinder.height / 2, 0.0);
  const double apart = radius - cylinder.radius;
  const double x = (apart * apart + beyond * beyond) / (2 * cylinder.radius * radius + 1e-30);
  const double eta = logarithm(1 + x + std::sqrt(x * (2 + x)));
  const double needed = -logarithm(tolerance) / std::max(eta, 1e-6);
  std::size_t nodes = 8;
  while (nodes < most_nodes && static_cast<double>(nodes) < needed) nodes *= 2;
  return nodes;
}

}  // namespace

Vector3 box_field(const Vector3& size, const Vector3& magnetisation, const Vector3& point) {
  const Vector3 low = point + size / 2;
  const Vector3 high = point - size / 2;
  const auto corners = [&](int u, int v, int w) {
    return Corners{{low[u], high[u]}, {low[v], high[v]}, {low[w], high[w]}};
  };
  const Vector3& m = magnetisation;
  const double xy = m.x() != 0 || m.y() != 0 ? sum_of_logarithms(corners(0, 1, 2)) : 0;
  const double xz = m.x() != 0 || m.z() != 0 ? sum_of_logarithms(corners(0, 2, 1)) : 0;
  const double yz = m.y() != 0 || m.z() != 0 ? sum_of_logarithms(corners(1, 2, 0)) : 0;
  const double xx = m.x() != 0 ? sum_of_angles(corners(1, 2, 0)) : 0;
  const double yy = m.y() != 0 ? sum_of_angles(corners(0, 2, 1)) : 0;
  const double zz = m.z() != 0 ? sum_of_angles(corners(0, 1, 2)) : 0;
  return magnetic_constant * Vector3(m.x() * xx - m.y() * xy - m.z() * xz,
                                     m.y() * yy - m.x() * xy - m.z() * yz,
                                     m.z() * zz - m.x() * xz - m.y() * yz);
}

Vector3 cylinder_field(const Cylinder& cylinder, const Vector3& magnetisation, const Vector3& point,
                       double tolerance) {
  const Circle& table = circle();
  const double rho = std::sqrt(point.x() * point.x() + point.y() * point.y());
  const std::size_t nodes = nodes_needed(cylinder, rho, point.z(), tolerance);
  const double low = point.z() - cylinder.height / 2;
  const double high = point.z() + cylinder.height / 2;
  const bool beyond = low > 0 || high < 0;
  Vector3 sum = Vector3::Zero();
  for (std::size_t k = 0; k < most_nodes; k += most_nodes / nodes) {
    const double c = table.cosine[k];
    const double s = table.sine[k];
    const double x = point.x() - cylinder.radius * c;
    const double y = point.y() - cylinder.radius * s;
    const double across = std::max(x * x + y * y, 1e-24);
    const double r0 = std::sqrt(across + low * low);
    const double r1 = std::sqrt(across + high * high);
    // Integrals over u from low to high of 1 / r^3 and of u / r^3.
    const double flat = beyond ? (high * high - low * low) / (r0 * r1 * (high * r0 + low * r1))
                               : (high * r0 - low * r1) / (across * r0 * r1);
    const double tilted = 1 / r0 - 1 / r1;
    const double charge = magnetisation.x() * c + magnetisation.y() * s;
    sum += Vector3(charge * x * flat + magnetisation.z() * c * tilted,
                   charge * y * flat + magnetisation.z() * s * tilted,
                   charge * tilted - magnetisation.z() * (c * x + s * y) * flat);
  }
  return magnetic_constant * cylinder.radius * (2 * pi / static_cast<double>(nodes)) * sum;
}

Vector3 shape_field(const Shape& shape, const Vector3& moment, const Vector3& point,
                    double tolerance) {
  const Vector3 magnetisation = moment / volume(shape);
  if (const auto* box = std::get_if<Box>(&shape)) return box_field(box->size, magnetisation, point);
  return cylinder_field(std::get<Cylinder>(shape), magnetisation, point, tolerance);
}

Vector3 outside(const Shape& shape, const Vector3& point) {
  constexpr double beyond = 1e-9;  // of the size
  if (const auto* box = std::get_if<Box>(&shape)) {
    const Vector3 depth = (1 + beyond) * box->size / 2 - point.cwiseAbs();
    int nearest = 0;
    if (depth.minCoeff(&nearest) <= 0) return point;
    Vector3 moved = point;
    moved[nearest] += std::copysign(depth[nearest], point[nearest]);
    return moved;
  }
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    const double radius = std::sqrt(point.x() * point.x() + point.y() * point.y());
    const double radial = (1 + beyond) * cylinder->radius - radius;
    const double axial = (1 + beyond) * cylinder->height / 2 - std::fabs(point.z());
    if (std::min(radial, axial) <= 0) return point;
    if (axial <= radial) {
      return {point.x(), point.y(), point.z() + std::copysign(axial, point.z())};
    }
    // From the axis half a step from one of the nodes of cylinder_field(), where its error is
    // least.
    if (radius == 0) return {0.9999811752826011 * radial, 0.006135884649154475 * radial, point.z()};
    const double outwards = (radius + radial) / radius;
    return {point.x() * outwards, point.y() * outwards, point.z()};
  }
  return point;
}

double distance_outside(const Shape& shape, const Vector3& point) {
  if (const auto* box = std::get_if<Box>(&shape)) {
    return (point.cwiseAbs() - box->size / 2).cwiseMax(0).norm();
  }
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    const double radial =
        std::max(std::sqrt(point.x() * point.x() + point.y() * point.y()) - cylinder->radius, 0.0);
    const double axial = std::max(std::fabs(point.z()) - cylinder->height / 2, 0.0);
    return std::sqrt(radial * radial + axial * axial);
  }
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    return std::max(point.norm() - sphere->radius, 0.0);
  }
  return point.norm();
}

}  // namespace ziggurat::magnetism
