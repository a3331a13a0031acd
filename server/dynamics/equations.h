#pragma once
// The equations of motion M(q) dv/dt + c(q, v) = generalised forces.
//   mass matrix       composite rigid bodies (Featherstone 2008, section 6.2)
//   bias forces       recursive Newton-Euler (section 5.3), all about one point in world axes
//   factors           M = L^T D L without fill-in along the tree (section 6.5)

#include <span>

#include "dynamics/tree.h"

namespace ziggurat::dynamics {

/// Fills tree.mass, with both triangles, and tree.own_inertia; needs place().
void compute_mass(Tree& tree);

/// Coriolis, centrifugal and gyroscopic forces c(q, v); needs place(), move() and compute_mass().
/// @param out  of each dof [N m] or [N]
void bias_forces(Tree& tree, std::span<double> out);

/// What acts from outside as generalised forces; needs place().
/// @param out      of each dof [N m] or [N]
/// @param fields   whether Tree::external counts;  @param gravity  whether gravity does
void external_forces(Tree& tree, std::span<double> out, bool fields, bool gravity);

/// Factors tree.mass, with the joints' damping over a time added, into tree.factor.
/// @param length  [s]; 0: the mass matrix alone
void factor_mass(Tree& tree, double length);

/// x := M^-1 x with the factors.
/// @param x  of each dof
void solve_mass(const Tree& tree, double* x);

/// What a unit force or torque at a dof changes of its speed: (M^-1)_kk [1/kg] or [1/(kg m^2)];
/// needs the factors.
double mobility(Tree& tree, int dof);

/// dv/dt at the state (q, v) of the tree under gravity alone; places, moves and factors it.
/// @param out  of each dof [rad/s^2] or [m/s^2]
void accelerations(Tree& tree, std::span<double> out);

}  // namespace ziggurat::dynamics
