// SPDX-License-Identifier: MIT
#include "magnetism/dipole.h"

#include <algorithm>
#include <cmath>

namespace ziggurat::magnetism {

Vector3 dipole_field(const Vector3& moment, const Vector3& r, double minimum_distance) {
  const double inverse = 1 / std::max(r.norm(), minimum_distance);
  const Vector3 n = r * inverse;
  return magnetic_constant * inverse * inverse * inverse * (3 * moment.dot(n) * n - moment);
}

Interaction dipole_pair(const Vector3& first, const Vector3& second, const Vector3& r,
                        double minimum_distance) {
  const double inverse = 1 / std::max(r.norm(), minimum_distance);
  const Vector3 n = r * inverse;
  const double first_along = first.dot(n);
  const double second_along = second.dot(n);
  const double cube = magnetic_constant * inverse * inverse * inverse;
  Interaction result;
  result.force_on_first = 3 * cube * inverse *
                          (second_along * first + first_along * second +
                           (first.dot(second) - 5 * (first_along * second_along)) * n);
  result.torque_on_first = first.cross(cube * (3 * second_along * n - second));
  result.torque_on_second = second.cross(cube * (3 * first_along * n - first));
  return result;
}

double dipole_energy(const Vector3& first, const Vector3& second, const Vector3& r) {
  return -first.dot(dipole_field(second, r));
}

Vector3 moment_of_dialect_field(const Vector3& field, double force_constant) {
  return field * std::sqrt(force_constant / magnetic_constant);
}

Vector3 moment_of_remanence(const Vector3& remanence, double volume) {
  return remanence * (volume / vacuum_permeability);
}

}  // namespace ziggurat::magnetism
