#pragma once
// Nutation that is too fast for a substep. The axis of a body that spins turns about its angular momentum; impulses and places of one
// step know it at the step's beginning only, so a top on its tip leaned over by tens of degrees.

#include "dynamics/problem.h"

namespace ziggurat::dynamics {

/// Into how many parts the step of an island should be divided so that the axes of what is in contact can be followed. A single
/// body nutates by the speed of its spin, times the spread of its moments of inertia over the middle one; what turns on a revolute
/// joint by its angular momentum in the joint, times the mobility of turning across it.
/// @return  1: it need not be
int parts_for_gyroscopic_stiffness(const Problem& problem, Workspace& work);

}  // namespace ziggurat::dynamics
