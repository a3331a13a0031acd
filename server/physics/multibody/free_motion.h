// SPDX-License-Identifier: MIT
#pragma once
// Motion without contacts and limits.

#include "physics/multibody/equations.h"

namespace ziggurat::dynamics {

/// Evaluations of the equations of motion in a step of a tree that is no single body.
inline constexpr int evaluations_per_step = 6;

/// Integrates a tree without contacts and limits, under constant external wrenches and servo
/// forces. Leaves its kinematics valid.
///
/// A single body: its centre of mass exactly; its angular momentum exactly; its orientation by the
/// classical Runge-Kutta method of fourth order in steps of at most 0.05 rad, exactly where it
/// keeps its axis. Other trees: the method of Dormand and Prince of order 5 (J. Comput. Appl. Math.
/// 6, 1980, table 2) with steps chosen by its estimate of the error.
/// A tree that would need more than some ten thousand steps is behind at the substep's end: then
/// work.ran_out_of_steps becomes true.
/// Prescribed joint velocities start with an impulse; all other servo forces last for the substep.
/// @param time_step  [s]
/// @param drive   prescribed joints; a single body has none
/// @return        the number of steps
int integrate_free_motion(Tree& tree, Workspace& work, double time_step,
                          const PrescribedJoints& drive = {});

/// Applies the impulse of a tree's external wrenches over a time [s]. Leaves its velocity
/// kinematics valid.
void kick(Tree& tree, Workspace& work, double time_step);

/// Predicts the generalised momentum at the end of a substep without contacts, at the mass matrix
/// of its beginning: M(q) v plus the impulses of external and bias forces. The damping of joints is
/// left out: it is implicit (see problem.h).
/// work.root_bias_impulse becomes time_step c of the root: a floating tree as a whole does not lose
/// this momentum, because its mass matrix changes with its shape.
/// Needs forward_kinematics(), velocity_kinematics() and compute_mass_matrix(), and leaves them
/// valid.
/// @param time_step  [s]
/// @param driven  whether servos hold some coordinates. Then free motion over the whole substep
///                would let go of them, and is used for large changes of velocity only
/// @param out     of each dof [kg m/s] or [kg m^2/s]
void predict_momentum(Tree& tree, Workspace& work, double time_step, bool driven,
                      std::span<double> out);

}  // namespace ziggurat::dynamics
