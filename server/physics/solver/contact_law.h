#pragma once
// The contact law, exact and linearised: g = P(y) with y = g - (u + c g - s) / m.
// u: constraint velocity; s: target velocity; m: mobility; c: compliance along the normal.
// P clips the normal impulse at 0, and friction to discs whose radii are the coefficients times the
// normal impulse (Alart and Curnier, Comput. Methods Appl. Mech. Eng. 92, 1991). It is Coulomb's
// law; an associated cone would lift sliding contacts.

#include "physics/solver/problem.h"

namespace ziggurat::dynamics {

/// Impulses of a constraint, linear in its velocities near a state: g = constant - hessian u.
struct LinearisedLaw {
  bool is_zero = true;  ///< no impulse at all
  std::array<double, Constraint::most_rows> constant{};
  std::array<double, Constraint::most_rows * Constraint::most_rows> hessian{};  ///< row by row, rows x rows
};

/// Linearises the law at velocities u. A held row without compliance gets 1e-8 of its mobility,
/// times the impulse's change. So redundant contacts have a solution.
/// @param u  the constraint's velocities
void linearise(const Constraint& constraint, const double* u, LinearisedLaw& out);

/// The regularised law: y is taken about the constraint's multiplier, with `regularisation` times
/// the mobility as compliance. Where multiplier and impulse agree it is the contact law itself.
/// @param about_multipliers  false: y is taken about 0, so friction is viscous until it slides
/// @param impulse  out: of each row
/// @param out      out: its linearisation; may be null
void regularise(const Constraint& constraint, const double* u, double regularisation, bool about_multipliers, double* impulse, LinearisedLaw* out);

/// Residual of the law at a constraint: the largest |g - P(y)| m [m/s] or [rad/s].
double residual(const Constraint& constraint, const double* u);

/// Merit function of a constraint: the sum of m (g - P(y))^2 [J].
double merit(const Constraint& constraint, const double* u);

/// Projects impulses on the law's bounds at their own normal impulse.
void project(const Constraint& constraint, double* impulse);

}  // namespace ziggurat::dynamics
