#pragma once
// What a substep with contacts gives a tree by turning it. Coriolis and gyroscopic forces do no work, but
// velocities are solved with the mass matrix of the beginning, and are then those of other poses.

#include <optional>
#include <span>
#include <vector>

#include "dynamics/problem.h"

namespace ziggurat::dynamics {

/// The excess of each tree that turns far, less the kinetic energy that it has at the end; to be called when an
/// island's velocities are solved, but not yet its trees'.
/// @param out  of each tree of the island [J]
void note_excesses(const Problem& problem, Workspace& work, std::vector<std::optional<double>>& out);

/// What undoes overlaps lifts what fell too deep; where something rebounds nothing is added, as that is lifted to
/// where it should be.
/// @param problem  that of the displacement, solved
void add_lifts(const Problem& problem, Workspace& work, std::vector<std::optional<double>>& out);

/// Whether an excess is more than rounding; needs move().
bool gains_much(const Tree& tree, double excess);

/// Takes an excess of kinetic energy from a tree: from its joints as far as they have it, so that its momentum and
/// angular momentum stay if it is free, and what is left from its turning. Needs move(), and leaves it moved.
/// @param excess  [J]; nothing happens where it is no gain
void take_excess(Tree& tree, Workspace& work, double excess);

/// The same from all trees of an island, in proportion to their kinetic energy.
void take_excess(std::span<Tree* const> trees, Workspace& work, double excess);

/// The energy of all trees, kinetic and potential [J]; needs move().
double energy(std::span<Tree* const> trees);

}  // namespace ziggurat::dynamics
