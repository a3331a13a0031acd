#pragma once
// Where bodies that are no balls rebound, Newton's law of restitution at each point can add energy: several
// points strike at once, friction turns the body, or it turns far within the substep. An island takes as much
// of the way from the impact without rebound to that with it as adds none.

#include <optional>
#include <vector>

#include "dynamics/newton.h"

namespace ziggurat::dynamics {

/// What bounds the rebounds of an island in a substep.
struct RestitutionEnergy {
  double most_energy = 0;  ///< kinetic and potential, at the substep's end [J]
  std::optional<double> throughout;   ///< the same without pushes, where these act throughout the substep [J]
  Iterate without;        ///< the solution without rebound
  std::vector<double> before;         ///< velocities at the substep's beginning, of each dof
  std::vector<double> start;          ///< velocities at the substep's beginning, with what pushes give, of each dof
  std::vector<double> after, change;  ///< memory of functions
};

/// Whether a contact of the island pushes and rebounds; to be called when its problem is solved.
bool rebounds(const Problem& problem);

/// Weakens rebounds until the work of all contacts is no gain.
/// @param problem  solved, its trees as they were
void bound_restitution(Problem& problem, VelocitySolver& solver, Workspace& work, RestitutionEnergy& out);

/// Whether what moves rebounds to where they should be lifts bodies by more than they have energy for: several
/// points of a mechanism that rebound at different times.
/// @param problem  that of the displacement, solved, its trees with the velocities that they will have; moves them
/// @param step     displacements without it, of each dof [rad], [m]
bool lifts_too_much(const Problem& problem, Workspace& work, const RestitutionEnergy& rebound,
                    const std::vector<double>& step);

/// Shortens what moves rebounds to where they should be, until it moves nothing by more than it could have moved: points
/// that strike at different times may ask for what only a large turn satisfies.
/// @param problem  that of the displacement, solved, its trees with the velocities that they will have
void bound_way(Problem& problem, const RestitutionEnergy& rebound);

/// Takes what the rebounds gained all the same, at the substep's end: where bodies turn far, or what undoes overlaps
/// lifts them. Needs velocity_kinematics(), and leaves the trees moved.
/// @param step  displacements of the substep, of each dof [rad], [m]
void bound_energy(const Problem& problem, Workspace& work, RestitutionEnergy& rebound, const std::vector<double>& step);

}  // namespace ziggurat::dynamics
