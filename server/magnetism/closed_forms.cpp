// SPDX-License-Identifier: MIT
#include "magnetism/closed_forms.h"

#include <algorithm>
#include <cmath>

namespace ziggurat::magnetism {
namespace {

/// ln(r - u) where r^2 = u^2 + rest, without cancellation; 0 in the limit that its factor kills.
double logarithm_of_difference(double r, double u, double rest) {
  const double difference = u > 0 ? rest / (r + u) : r - u;
  return difference > 0 ? std::log(difference) : 0;
}

double sign_of(double x) { return x > 0 ? 1 : (x < 0 ? -1 : 0); }

/// @param touching  the angle's limit for w = 0 and u v > 0: pi / 2 from above, -pi / 2 from below
Vector3 corner_term(double u, double v, double w, double touching) {
  const double r = std::sqrt(u * u + v * v + w * w);
  const double log_u = logarithm_of_difference(r, u, v * v + w * w);
  const double log_v = logarithm_of_difference(r, v, u * u + w * w);
  const double angle = w != 0 ? std::atan(u * v / (r * w)) : touching * sign_of(u * v);
  return {(v * v - w * w) / 2 * log_u + u * v * log_v + v * w * angle + r * u / 2,
          (u * u - w * w) / 2 * log_v + u * v * log_u + u * w * angle + r * v / 2,
          -u * w * log_u - v * w * log_v + u * v * angle - r * w};
}

}  // namespace

Vector3 parallel_box_force(const Vector3& first_size, const Vector3& second_size,
                           const Vector3& offset, double first_remanence, double second_remanence) {
  Vector3 sum = Vector3::Zero();
  for (int corners = 0; corners < 64; ++corners) {
    double at[3];
    double sign = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double first = corners >> (2 * axis) & 1 ? 0.5 : -0.5;
      const double second = corners >> (2 * axis + 1) & 1 ? 0.5 : -0.5;
      at[axis] = offset[axis] + second * second_size[axis] - first * first_size[axis];
      sign *= 4 * first * second;
    }
    sum += sign * corner_term(at[0], at[1], at[2], std::copysign(pi / 2, offset.z()));
  }
  return sum * (first_remanence * second_remanence / (4 * pi * vacuum_permeability));
}

double coaxial_cylinder_force(double radius, double first_height, double second_height, double gap,
                              double first_remanence, double second_remanence) {
  const auto integrand = [&](double q) {
    const double j = std::cyl_bessel_j(1.0, q);
    return j * j / q * (1 - std::exp(-q * first_height / radius)) *
           (1 - std::exp(-q * second_height / radius)) * std::exp(-q * gap / radius);
  };
  // Simpson's rule as far as the exponential reaches; the integrand starts as q^3.
  const double end = 40 * radius / gap;
  const int steps = 2 * static_cast<int>(std::ceil(std::max(end / 0.08, 500.0)));
  const double step = end / steps;
  double sum = integrand(end);
  for (int k = 1; k < steps; ++k) sum += (k % 2 == 1 ? 4 : 2) * integrand(k * step);
  return pi * radius * radius * first_remanence * second_remanence / vacuum_permeability * sum *
         step / 3;
}

}  // namespace ziggurat::magnetism
