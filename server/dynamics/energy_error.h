#pragma once
// What a substep with contacts gives a tree by turning it. Coriolis and gyroscopic forces do no work, but
// velocities are solved with the mass matrix of the beginning, and are then those of other poses.

#include <span>
#include <vector>

#include "dynamics/problem.h"

namespace ziggurat::dynamics {

/// The excess of one tree.
struct EnergyError {
  enum class Kind : unsigned char {
    none,       ///< too small to matter
    coriolis,      ///< Coriolis forces change its speeds: gains and losses are undone
    large_rotation,  ///< as well, and it turns so far that what its joints can't undo of a gain is taken all the same
  };
  Kind kind = Kind::none;
  bool of_free_joints = false;  ///< alone: what servos hold moves as they are told
  double before_kinetic = 0;            ///< less the kinetic energy that it, or those, have at the end [J]
};

/// What a substep gives the trees of an island.
struct IslandEnergyErrors {
  std::vector<EnergyError> of_trees;
  static constexpr unsigned char free = 0, separate = 1, driven = 2;
  /// Of each dof: free; apart, because a limit holds it, or it spins (see TreeModel) and no error of turning is its own; or driven by a servo.
  std::vector<unsigned char> held;
  std::vector<double> velocities, bias_of_held, bias_of_free;  ///< of compute_energy_errors(), which uses their memory again
};

/// Notes the excess of each tree; to be called when an island's velocities are solved, but not yet its trees'.
void compute_energy_errors(const Problem& problem, Workspace& work, IslandEnergyErrors& out);

/// What undoes overlaps lifts what fell too deep; where something rebounds nothing is added, as that is lifted to
/// where it should be.
/// @param problem  that of the displacement, solved
void add_lift_energy(const Problem& problem, Workspace& work, IslandEnergyErrors& out);

/// Gives a tree at the substep's end the energy that it should have. Needs velocity_kinematics(), and leaves it moved.
/// @param held      of its dofs, see IslandEnergyErrors
/// @param grounded  whether its island touches the world, so that its angular momentum is not its own
void correct_energy(Tree& tree, Workspace& work, const EnergyError& excess, std::span<const unsigned char> held,
                 bool grounded);

/// Whether an excess is more than rounding; needs velocity_kinematics().
bool exceeds_rounding(const Tree& tree, double excess);

/// Takes an excess of kinetic energy from a tree: from its joints as far as they have it, so that its momentum and
/// angular momentum stay if it is free, and what is left from its turning. Needs velocity_kinematics(), and leaves it moved.
/// @param excess  [J]; nothing happens where it is no gain
void remove_kinetic_energy(Tree& tree, Workspace& work, double excess);

/// The same from all trees of an island, in proportion to their kinetic energy.
void remove_kinetic_energy(std::span<Tree* const> trees, Workspace& work, double excess);

/// The energy of all trees, kinetic and potential [J]; needs velocity_kinematics().
double energy(std::span<Tree* const> trees);

/// The energy of an island with joints that no servo and no field moves, at the step's beginning [J]; of others infinity.
double energy_if_passive(const Problem& problem);

/// Takes what such an island gained when its trees have moved. So links that snap taut or are struck within a step can't throw others.
/// @param before    see energy_if_passive()
/// @param grounded  see correct_energy(); otherwise its momentum stays
/// @param is_part   nothing is left; otherwise as much as a whole step may be off by: a fiftieth of its kinetic energy, and half of what its weight
///                  does along it
void bound_gain(const Problem& problem, Workspace& work, double before, bool grounded, bool is_part);

}  // namespace ziggurat::dynamics
