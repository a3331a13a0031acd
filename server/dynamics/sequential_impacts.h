#pragma once
// Impacts that follow one another within a substep: a ball that is struck strikes the next one.

#include <span>

#include "dynamics/problem.h"

namespace ziggurat::dynamics {

/// Largest tree whose responses are computed.
inline constexpr int most_dofs_struck = 32;

/// A contact with restitution that may be met within a substep.
struct RestitutionContact {
  Constraint* constraint = nullptr;
  double speed = 0;  ///< with which its surfaces part at the substep's beginning [m/s]
  double pull = 0;   ///< what free fall accelerates its surfaces apart by [m/s^2]
};

/// Velocity change of a constraint's first row by a unit impulse of another's first row [1/kg]. The
/// first one's trees have no more than `most_dofs_struck`.
double response(const Problem& problem, const Constraint& impulse, const Constraint& speed);

/// Lets impacts take place in the order of time, those of one moment together, and has their contacts seek the speeds and gaps that
/// remain. Without friction.
/// @param impacts  all contacts of the island that may be met; trees of at most `most_dofs_struck`, one impact for each face of a pair
/// @return         whether there was one, and no more than 64 for each contact
bool resolve_in_time_order(Problem& problem, std::span<const RestitutionContact> impacts);

}  // namespace ziggurat::dynamics
