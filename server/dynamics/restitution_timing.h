#pragma once
// When contacts with restitution are met within a substep, and how they rebound.

#include "dynamics/newton.h"

namespace ziggurat::dynamics {

/// Solves an island's problem, all of whose constraints are there, for its velocities. Contacts with restitution seek the speeds with
/// which they rebound.
///
/// What carries a body still does in the impact; what nothing carries falls freely before and after it. A push that
/// is small beside its speed acts likewise, a larger one before it. Limits hold at
/// the bound that the speeds pass.
SolverResult solve_velocities(Problem& problem, VelocitySolver& solver);

}  // namespace ziggurat::dynamics
