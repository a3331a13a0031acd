#pragma once
// Motion without contacts and limits.

#include "dynamics/equations.h"

namespace ziggurat::dynamics {

/// Advances q and v of a tree that nothing but its external wrenches and motors of joints acts on, which stay the
/// same meanwhile. Leaves it placed and moved.
///
/// A single body: its centre of mass exactly; its angular momentum exactly; its orientation by
/// the classical Runge-Kutta method of fourth order in steps of at most 0.05 rad, exactly where it
/// keeps its axis. Other trees: the method of Dormand and Prince of order 5 (J. Comput. Appl.
/// Math. 6, 1980, table 2) with steps chosen by its estimate of the error.
/// A tree that would need more than some ten thousand steps is behind at the substep's end: work.late becomes true.
/// Speeds that servos hold are so from the beginning on, where they become so by an impulse; all other pushes of servos last.
/// @param length  [s]
/// @param drive   what motors do; a single body has none
/// @return        how many steps it took
int integrate_free_motion(Tree& tree, Workspace& work, double time_step, const PrescribedJoints& drive = {});

/// Changes the speeds of a tree in flight by what pushes it, over a length of time [s]. Leaves it moved.
void kick(Tree& tree, Workspace& work, double time_step);

/// The generalised momentum that a tree would have at the end of a substep without contacts, at the
/// mass matrix of its beginning: M(q) v plus what its forces and its own motion add. The damping of
/// joints is not in it: it is implicit (see problem.h).
/// work.drift becomes what the momentum of a floating tree as a whole would be more than that: with
/// its shape the mass matrix changes too.
/// Needs forward_kinematics(), velocity_kinematics() and compute_mass_matrix(), and leaves the tree so.
/// @param length  [s]
/// @param driven  whether servos hold some of its coordinates: then a free motion over the whole substep, in which
///                nothing holds them, is farther off than forces of the beginning are, unless they change speeds by much
/// @param out     of each dof [kg m/s] or [kg m^2/s]
void predict_momentum(Tree& tree, Workspace& work, double time_step, bool driven, std::span<double> out);

}  // namespace ziggurat::dynamics
