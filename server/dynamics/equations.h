#pragma once
// The equations of motion M(q) dv/dt + c(q, v) = generalised forces.
//   mass matrix       composite rigid bodies (Featherstone 2008, section 6.2)
//   bias forces       recursive Newton-Euler (section 5.3), all about one point in world axes
//   factors           M = L^T D L without fill-in along the tree (section 6.5)

#include <array>
#include <span>
#include <vector>

#include "dynamics/tree.h"

namespace ziggurat::dynamics {

/// What is computed of one tree, in memory that the next tree uses again: it stays in the nearest
/// cache, however many trees there are.
struct Workspace {
  std::vector<Inertia> link_inertia;  ///< of each link alone, about O
  std::vector<Inertia> composite_inertia;      ///< of each link with all that it carries, about O
  std::vector<Wrench> wrench;        ///< on each link
  std::vector<Motion> acceleration;  ///< of each link
  std::vector<double> mass;          ///< mass matrix, dofs x dofs, row by row
  std::vector<double> factor;        ///< its factors
  std::vector<double> scratch;       ///< of each dof
  std::array<double, 6> root_bias_impulse{};     ///< by predict_momentum()
  double bias_velocity_change = 0;                ///< relative change of a tree's speeds by Coriolis forces, by predict_momentum()
  bool ran_out_of_steps = false;                 ///< a flight ran out of steps before the end of its substep
  std::vector<double> stages;        ///< of the integrator, see free_motion.h
  std::vector<double> saved_state;        ///< q and v, kept while a flight is tried
};

/// Fills work.mass, with both triangles, and work.link_inertia; needs forward_kinematics(). All other functions
/// need it, for the same tree.
void compute_mass_matrix(const Tree& tree, Workspace& work);

/// What links accelerate by while all speeds of coordinates stay, into work.acceleration: spatial, about O; needs forward_kinematics()
/// and velocity_kinematics().
void bias_accelerations(const Tree& tree, Workspace& work);

/// Coriolis, centrifugal and gyroscopic forces c(q, v); needs forward_kinematics() and velocity_kinematics().
/// @param out  of each dof [N m] or [N]
void bias_forces(const Tree& tree, Workspace& work, std::span<double> out);

/// What acts from outside as generalised forces; needs forward_kinematics().
/// @param out      of each dof [N m] or [N]
/// @param fields   whether Tree::external counts;  @param gravity  whether gravity does
void external_forces(const Tree& tree, Workspace& work, std::span<double> out, bool fields,
                     bool gravity);

/// Factors work.mass, with the joints' damping over a time added, into work.factor.
/// @param length  [s]; 0: the mass matrix alone
void factor_mass_matrix(const Tree& tree, Workspace& work, double time_step);

/// x := M^-1 x with the factors.
/// @param x  of each dof
void solve_mass_matrix(const Tree& tree, const Workspace& work, double* x);

/// What a unit force or torque at a dof changes of its speed: (M^-1)_kk [1/kg] or [1/(kg m^2)];
/// needs the factors.
double mobility(const Tree& tree, Workspace& work, int dof);

/// What servos do to a tree: they hold the speeds of some dofs, and push others. Of each dof; empty: there are none.
struct PrescribedJoints {
  std::span<const unsigned char> prescribed;  ///< whether its speed stays
  std::span<const double> velocity;        ///< of those that are held [rad/s] or [m/s]
  std::span<const double> force;         ///< on the others [N m] or [N]
  bool prescribes(std::size_t dof) const { return dof < prescribed.size() && prescribed[dof]; }
};

/// x := M^-1 x, where those that are held change by what x says, whatever it takes; work.mass and the factors are used up.
/// @param x  of each dof: impulses, and changes of speed of those that are held
void solve_prescribed(const Tree& tree, Workspace& work, const PrescribedJoints& drive, std::span<double> x);

/// dv/dt at the state (q, v) of the tree under gravity and what drives it; places, moves and factors it.
/// @param out  of each dof [rad/s^2] or [m/s^2]
void forward_dynamics(Tree& tree, Workspace& work, const PrescribedJoints& drive, std::span<double> out);

}  // namespace ziggurat::dynamics
