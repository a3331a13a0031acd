#pragma once
// Energy bound of restitution. Newton's law at each point can add energy where several points
// strike at once, friction turns the body, or it rotates far within the substep. The gain is taken
// back at the substep's end.

#include <vector>

#include "dynamics/newton.h"

namespace ziggurat::dynamics {

/// Energy bound of an island's impacts in a substep.
struct RestitutionEnergy {
  double most_energy = 0;  ///< kinetic and potential, at the substep's end [J]
  Iterate without;        ///< the solution without rebound
  std::vector<double> after, change;  ///< memory of functions
};

/// Whether a contact of the island pushes and rebounds; to be called when its problem is solved.
bool rebounds(const Problem& problem);

/// Energy that the island may have at the substep's end: that of its beginning, and the work of
/// pushes and servos.
/// @param problem  solved, its trees as they were
void compute_energy_bound(Problem& problem, VelocitySolver& solver, Workspace& work, RestitutionEnergy& out);

/// Takes what the rebounds gained, at the substep's end. Needs velocity_kinematics(), and leaves the trees moved.
void bound_energy(const Problem& problem, Workspace& work, RestitutionEnergy& rebound);

}  // namespace ziggurat::dynamics
