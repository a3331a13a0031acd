// SPDX-License-Identifier: MIT
#pragma once
// Point dipoles: the closed formulas for one pair, in SI. Field B1 of a dipole m2 at m1, with the
// torque and force on m1; the separation is r = x1 - x2, n = r / d, and K = mu0 / 4 pi:
//
//   B1 = K / d^3 [3 (m2.n) n - m2]
//
//   T1 = m1 x B1
//
//   F1 = 3 K / d^4 [(m2.n) m1 + (m1.n) m2 + (m1.m2 - 5 (m1.n)(m2.n)) n]
//
// Below minimum_distance the separation counts as minimum_distance long while n = r /
// minimum_distance. So force and torque stay finite and continuous, and vanish as they must at r =
// 0. T1 + T2 + r x F1 = 0 still holds exactly.

#include "math/pose.h"

namespace ziggurat::magnetism {

using math::Vector3;

/// mu0 / 4 pi [T m / A]
inline constexpr double magnetic_constant = 1e-7;
inline constexpr double pi = 3.14159265358979323846;
/// mu0 [T m / A]
inline constexpr double vacuum_permeability = 4 * pi * magnetic_constant;

/// A force through a stated point and a torque about it, in the world.
struct Wrench {
  Vector3 force = Vector3::Zero();   ///< [N]
  Vector3 torque = Vector3::Zero();  ///< [N m]
};

/// Wrench between two magnets. The force on the second is the opposite of the first's. So
/// torque_on_first + torque_on_second + r x force_on_first = 0.
struct Interaction {
  Vector3 force_on_first = Vector3::Zero();    ///< [N]
  Vector3 torque_on_first = Vector3::Zero();   ///< about the first's position [N m]
  Vector3 torque_on_second = Vector3::Zero();  ///< about the second's position [N m]
};

/// Field of a dipole.
/// @param moment            of the source [A m^2]
/// @param r                 from the source to the point [m]
/// @param minimum_distance  > 0 [m]
/// @returns flux density at the point [T]
Vector3 dipole_field(const Vector3& moment, const Vector3& r, double minimum_distance = 1e-6);

/// @param first, second     moments [A m^2]
/// @param r                 first position minus second position [m]
/// @param minimum_distance  > 0 [m]
Interaction dipole_pair(const Vector3& first, const Vector3& second, const Vector3& r,
                        double minimum_distance = 1e-6);

/// Energy of a pair of dipoles [J], zero when far apart.
double dipole_energy(const Vector3& first, const Vector3& second, const Vector3& r);

/// The moment [A m^2] that a field of the scene dialect stands for: the dialect's pair force is
/// force_constant b1 b2 / d^4 [...], so b is a moment in units of sqrt(force_constant / K) A m^2.
/// @param field           in the dialect's unit
/// @param force_constant  of the dialect, >= 0
Vector3 moment_of_dialect_field(const Vector3& field, double force_constant);

/// The moment [A m^2] of a uniformly magnetised body.
/// @param remanence  polarisation mu0 M [T]
/// @param volume     [m^3]
Vector3 moment_of_remanence(const Vector3& remanence, double volume);

}  // namespace ziggurat::magnetism
