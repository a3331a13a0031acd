// SPDX-License-Identifier: MIT
#pragma once
// The laws of constraints: contacts with sliding, spinning and rolling friction, servos and limits.
// All are one law, exact and linearised: g = P(y) with y = g - (u + c g - s) / m.
// u: constraint velocity; s: target velocity; m: mobility; c: compliance of the first row.
// P clips the first impulse to an interval, and friction to discs whose radii friction_bound()
// gives (Alart and Curnier, Comput. Methods Appl. Mech. Eng. 92, 1991). It is Coulomb's law; an
// associated cone would lift sliding contacts.
//
// A solver asks for linearise() or regularise(), residual() and merit(). Gauss-Seidel projects disc
// by disc, and the interior point method asks for cone_slope(). Another law of friction changes
// friction_bound(), and nothing else.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <type_traits>

#include "physics/solver/constraint.h"

namespace ziggurat::dynamics {

/// Rows of one contact (normal; two tangents; rotation about normal and tangents), servo or limit.
struct Constraint {
  static constexpr int most_rows = 6;
  enum class Law : unsigned char {
    contact,  ///< first impulse within [lower, upper], friction within its discs
    bounded,  ///< first impulse within [lower, upper], no other
    off       ///< no impulse
  };
  Law law = Law::off;
  int rows = 0;        ///< 1, 3 or 6
  int a = -1, b = -1;  ///< indices of the trees in the island, or -1
  int jacobian_a = 0,
      jacobian_b = 0;                   ///< into Problem::jacobian: `rows` rows, see jacobian.h
  std::span<const int> dofs_a, dofs_b;  ///< that move each side, ascending
  std::array<double, 3>
      friction{};  ///< coefficients of the discs: sliding [1], spinning and rolling [m]
  double lower = 0,
         upper = std::numeric_limits<double>::infinity();  ///< of the first impulse [N s], [N m s]
  std::array<double, most_rows>
      target_velocity{};  ///< the velocities that impulses drive to [m/s], [rad/s]
  std::array<double, most_rows> impulse{};   ///< [N s], [N m s]
  std::array<double, most_rows> mobility{};  ///< velocity change by a unit impulse, without
                                             ///< coupling of dofs; equal within a disc

  double compliance = 0;  ///< of a contact: closing velocity that a normal impulse leaves [1/kg]

  std::array<double, most_rows> multiplier{};  ///< of the regularised law [N s], [N m s]

  double gap = 0;  ///< of contacts and limits [m] or [rad]
  double gap_acceleration =
      0;  ///< of a contact that rotates: the gap's second derivative without forces [m/s^2]
  double range = 0;                 ///< of a limit: distance of its bounds [m] or [rad]
  double restitution = 0;           ///< of a contact
  Matrix3 frame = Matrix3::Zero();  ///< columns: normal and tangents of a contact
  int source = 0;                   ///< into the contacts, servos or limits of the system
  /// Whether the first impulse is strictly within its bounds: then it reaches its target velocity.
  bool is_unsaturated() const { return lower < impulse[0] && impulse[0] < upper; }
  enum class Kind : unsigned char { contact, servo, limit } kind = Kind::contact;
};

/// Calls f with a number of rows as a compile-time constant.
template <class F>
void dispatch_rows(int rows, F f) {
  switch (rows) {
    case 1:
      return f(std::integral_constant<int, 1>());
    case 3:
      return f(std::integral_constant<int, 3>());
    default:
      return f(std::integral_constant<int, Constraint::most_rows>());
  }
}

/// Sets kind, rows and bounds of a constraint.
void set_law(const ContactPoint& contact, Constraint& constraint);
void set_law(const Servo& servo, Constraint& constraint);
void set_law(const Limit& limit, Constraint& constraint);

/// Rows that may have an impulse; the first of `rows`.
inline int acting_rows(const Constraint& constraint) {
  return constraint.law == Constraint::Law::contact   ? constraint.rows
         : constraint.law == Constraint::Law::bounded ? 1
                                                      : 0;
}

/// Rows whose friction has one bound.
struct FrictionDisc {
  int coefficient;  ///< index into Constraint::friction
  int first, size;  ///< rows: two, or one
};
inline constexpr std::array<FrictionDisc, 3> friction_discs{
    {{0, 1, 2}, {1, 3, 1}, {2, 4, 2}}};  // sliding, spinning, rolling

/// Discs of a constraint with so many acting rows.
constexpr std::span<const FrictionDisc> discs_of(int rows) {
  return std::span(friction_discs).first(rows / 2);
}

/// Whether the impulse along row r may change with the velocity along row c. Normal and tangents
/// may all; torques change with the normal velocity and those of their own disc.
constexpr bool depends(int r, int c) {
  return c == 0 || (r < 3 ? c < 3 : (r == 3) == (c == 3) && c >= 3);
}

/// Largest friction impulse of a disc.
struct FrictionBound {
  double value;       ///< [N s], [N m s]
  double per_normal;  ///< its derivative by the normal impulse
};

/// Coulomb's law, for a disc.
/// @param friction  coefficients of the constraint;  @param normal  impulse [N s]
/// @param slip      velocities of the disc's rows, on which Coulomb's law does not depend; a step
/// of Newton's
///                  method takes a bound that does as constant in them
inline FrictionBound friction_bound(const FrictionDisc& disc, const std::array<double, 3>& friction,
                                    double normal, const double* /*slip*/) {
  const double coefficient = friction[disc.coefficient];
  return {coefficient * normal, coefficient};
}

/// Projection on a disc: the share of y that is within the bound.
/// @param square  |y|^2
inline double friction_share(double bound, double square) {
  return square > bound * bound ? bound / std::sqrt(square) : 1;
}

/// Slope of the cone of sliding friction at velocities u: the bound over the normal impulse, > 0.
inline double cone_slope(const Constraint& constraint, const double* u) {
  constexpr double least = 1e-4;
  return std::max(friction_bound(friction_discs[0], constraint.friction, 1, u + 1).value, least);
}

/// Impulses of a constraint, linear in its velocities near a state: g = constant - hessian u.
struct LinearisedLaw {
  bool is_zero = true;  ///< no impulse at all
  std::array<double, Constraint::most_rows> constant{};
  std::array<double, Constraint::most_rows * Constraint::most_rows>
      hessian{};  ///< row by row, rows x rows
};

/// Linearises the law at velocities u. A held row without compliance gets 1e-8 of its mobility,
/// times the impulse's change. So redundant contacts have a solution.
/// @param u  the constraint's velocities
void linearise(const Constraint& constraint, const double* u, LinearisedLaw& out);

/// The regularised law: y is taken about the constraint's multiplier, with `regularisation` times
/// the mobility as compliance. Where multiplier and impulse agree it is the law itself.
/// @param about_multipliers  false: y is taken about 0, so friction is viscous until it slides
/// @param impulse  out: of each row
/// @param out      out: its linearisation; may be null
void regularise(const Constraint& constraint, const double* u, double regularisation,
                bool about_multipliers, double* impulse, LinearisedLaw* out);

/// Residual of the law at a constraint: the largest |g - P(y)| m [m/s] or [rad/s].
double residual(const Constraint& constraint, const double* u);

/// Merit function of a constraint: the sum of m (g - P(y))^2 [J].
double merit(const Constraint& constraint, const double* u);

}  // namespace ziggurat::dynamics
