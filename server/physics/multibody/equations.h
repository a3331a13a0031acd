// SPDX-License-Identifier: MIT
#pragma once
// Equations of motion M(q) dv/dt + c(q, v) = generalised forces (Featherstone 2008).
// Mass matrix: composite rigid bodies (section 6.2).
// Bias forces: recursive Newton-Euler (section 5.3), about one point in world axes.
// Factors: M = L^T D L without fill-in along the tree (section 6.5).
// Forward dynamics: articulated bodies (section 7.3), in a time proportional to the links.

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "physics/multibody/tree.h"

namespace ziggurat::dynamics {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// A link with the subtree that it carries, all of whose joints are free. Angular parts come before
/// linear ones.
struct ArticulatedBody {
  Matrix6 inertia = Matrix6::Zero();       ///< wrench over acceleration, about O
  Vector6 wrench = Vector6::Zero();        ///< that keeps the link's acceleration at zero
  Vector6 bias = Vector6::Zero();          ///< acceleration by velocities, relative to the parent
  Vector6 acceleration = Vector6::Zero();  ///< of the link
};

/// A dof of a joint, which divides an articulated body from its parent.
struct ArticulatedDof {
  Vector6 inertia = Vector6::Zero();  ///< wrench on the body by the dof's unit acceleration
  double mobility = 0;                ///< acceleration of the dof by a unit force; 0: prescribed
  double force = 0;                   ///< that accelerates it while the parent stands
};

/// Intermediate results of one tree, in memory that the next tree uses again: it stays in the
/// nearest cache, however many trees there are.
struct Workspace {
  std::vector<Inertia> link_inertia;          ///< of each link alone, about O
  std::vector<Inertia> composite_inertia;     ///< of each link with its subtree, about O
  std::vector<Wrench> wrench;                 ///< on each link
  std::vector<Wrench> link_momentum;          ///< of each link with its subtree, about O
  std::vector<Motion> acceleration;           ///< of each link
  std::vector<ArticulatedBody> bodies;        ///< of each link, by forward_dynamics()
  std::vector<ArticulatedDof> dofs;           ///< likewise
  std::vector<double> mass;                   ///< mass matrix, dofs x dofs, row by row
  std::vector<double> factor;                 ///< its factors
  std::vector<double> scratch;                ///< of each dof
  std::vector<double> momentum;               ///< M v, by bias_forces()
  std::array<double, 6> root_bias_impulse{};  ///< by predict_momentum()
  double bias_velocity_change =
      0;  ///< relative change of a tree's velocities by bias forces, by predict_momentum()
  bool ran_out_of_steps = false;  ///< an integration ran out of steps before the end of its substep
  std::vector<double> stages;     ///< of the integrator, see free_motion.h
  std::vector<double> saved_state;  ///< q and v, saved during a trial integration
};

/// Fills work.mass, with both triangles, and inertias; needs forward_kinematics(). All other
/// functions need it, for the same tree.
void compute_mass_matrix(const Tree& tree, Workspace& work);

/// out += factor M v, column by column: M is symmetric.
/// @param mass  n x n
void add_momentum(const double* mass, double factor, const double* v, int n, double* out);

/// Spatial accelerations of links about O at dv/dt = 0, into work.acceleration; needs
/// forward_kinematics() and velocity_kinematics().
void bias_accelerations(const Tree& tree, Workspace& work);

/// Coriolis, centrifugal and gyroscopic forces c(q, v), and work.momentum; needs
/// forward_kinematics() and velocity_kinematics().
/// @param out  of each dof [N m] or [N]
void bias_forces(const Tree& tree, Workspace& work, std::span<double> out);

/// Generalised forces of gravity, with the composite inertias of compute_mass_matrix().
/// @param out  of each dof [N m] or [N]
void gravity_forces(const Tree& tree, const Workspace& work, std::span<double> out);

/// Generalised forces of external wrenches and gravity; needs forward_kinematics().
/// @param out      of each dof [N m] or [N]
/// @param fields   whether Tree::external counts;  @param gravity  whether gravity does
void external_forces(const Tree& tree, Workspace& work, std::span<double> out, bool fields,
                     bool gravity);

/// Factors work.mass, with the joints' damping over a time added, into work.factor.
/// @param time_step  [s]; 0: the mass matrix alone
void factor_mass_matrix(const Tree& tree, Workspace& work, double time_step);

/// x := M^-1 x with the factors.
/// @param x  of each dof
void solve_mass_matrix(const Tree& tree, const Workspace& work, double* x);

/// Mobility of a dof: (M^-1)_kk [1/kg] or [1/(kg m^2)]; needs the factors.
double mobility(const Tree& tree, Workspace& work, int dof);

/// Joints whose servos prescribe their velocity, and forces of servos on other joints. Lists have
/// an entry for each dof; empty: no servos.
struct PrescribedJoints {
  std::span<const unsigned char> prescribed;  ///< whether its speed stays
  std::span<const double> velocity;           ///< of prescribed joints [rad/s] or [m/s]
  std::span<const double> force;              ///< on the others [N m] or [N]
  bool prescribes(std::size_t dof) const { return dof < prescribed.size() && prescribed[dof]; }
};

/// Solves M x = impulses, where prescribed dofs change by their given x; work.mass and the factors
/// are overwritten.
/// @param x  of each dof: impulse, or change of a prescribed velocity
void solve_prescribed(const Tree& tree, Workspace& work, const PrescribedJoints& drive,
                      std::span<double> x);

/// Forward dynamics: dv/dt at (q, v) under gravity and the servos' forces; updates kinematics.
/// @param out  of each dof [rad/s^2] or [m/s^2]
void forward_dynamics(Tree& tree, Workspace& work, const PrescribedJoints& drive,
                      std::span<double> out);

}  // namespace ziggurat::dynamics
