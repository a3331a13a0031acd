#pragma once
// The contact law, exact and linearised. With y = g - (u + c g - s) / m (s: the speed sought, m: the
// mobility, c: what a normal impulse makes surfaces give way, Constraint::compliance) it is the projection
// equation g = P(y): P clips the normal part at 0 and friction to discs whose radii are the
// coefficients times the normal part (Alart and Curnier, Comput. Methods Appl. Mech. Eng. 92, 1991). That is Coulomb's law without the lift of associated cones.

#include "dynamics/problem.h"

namespace ziggurat::dynamics {

/// A block's impulses as a function of its speeds near a state: g = constant - slope u.
struct LinearisedLaw {
  bool is_zero = true;  ///< no impulse at all
  std::array<double, Constraint::most_rows> constant{};
  std::array<double, Constraint::most_rows * Constraint::most_rows> hessian{};  ///< row by row, rows x rows
};

/// @param u  the block's speeds
/// Where the law holds a speed for which nothing gives way it is let go by 1e-8 of its mobility times the
/// impulse's change, so that contacts that say the same twice have a solution.
void linearise(const Constraint& constraint, const double* u, LinearisedLaw& out);

/// The softened law: y is taken about the block's anchor with `softness` times the mobility. Where
/// anchor and impulse agree it is the contact law itself.
/// @param anchors  otherwise y is taken about 0, so friction is viscous until it slides, and what gives way carries what it is pressed in by
/// @param impulse  out: of each row
/// @param out      out: its linearisation; may be null
void regularise(const Constraint& constraint, const double* u, double regularisation, bool about_multipliers, double* impulse, LinearisedLaw* out);

/// By how much the block's impulses and speeds miss the law [m/s] or [rad/s].
double residual(const Constraint& constraint, const double* u);

/// What the block misses the law by, as the energy of the impulses that are wrong [J].
double merit(const Constraint& constraint, const double* u);

/// Clips impulses to the law's bounds at their own normal part.
void project(const Constraint& constraint, double* impulse);

}  // namespace ziggurat::dynamics
