// SPDX-License-Identifier: MIT
#pragma once
// Error of the kinetic energy that rotation within a substep adds or removes. Coriolis and
// gyroscopic forces do no work. Velocities, however, are solved with the mass matrix of the
// substep's beginning, and are then combined with another pose.

#include <span>
#include <vector>

#include "physics/solver/problem.h"

namespace ziggurat::dynamics {

/// Energy error of one tree.
struct EnergyError {
  enum class Kind : unsigned char {
    none,            ///< too small to matter
    coriolis,        ///< Coriolis forces change its velocities: gains and losses are undone
    large_rotation,  ///< as well, and it rotates so far that the rest of a gain is removed from all
                     ///< velocities
  };
  Kind kind = Kind::none;
  bool of_free_joints = false;  ///< servos prescribe the other joints
  double before_kinetic =
      0;  ///< error, less the kinetic energy at the end of the tree or of its free joints [J]
};

/// Energy errors of the trees of an island.
struct IslandEnergyErrors {
  std::vector<EnergyError> of_trees;
  static constexpr unsigned char free = 0, separate = 1, driven = 2;
  /// State of each dof: free; separate (held by a limit, or a symmetric rotor, see TreeModel); or
  /// driven by a servo.
  std::vector<unsigned char> held;
  std::vector<double> velocities, bias_of_held,
      bias_of_free;  ///< of compute_energy_errors(), which uses their memory again
};

/// Computes the energy error of each tree; to be called when an island's velocities are solved, but
/// not yet applied.
void compute_energy_errors(const Problem& problem, Workspace& work, IslandEnergyErrors& out);

/// Adds the potential energy that undoing an overlap gives. Islands with an impact get none: their
/// displacement restores the height after the impact.
/// @param problem  the displacement problem, solved
void add_lift_energy(const Problem& problem, Workspace& work, IslandEnergyErrors& out);

/// Corrects a tree's energy at the substep's end. Needs velocity_kinematics(), and leaves it valid.
/// @param held      of its dofs, see IslandEnergyErrors
/// @param grounded  whether its island touches the world, so that angular momentum is not conserved
void correct_energy(Tree& tree, Workspace& work, const EnergyError& excess,
                    std::span<const unsigned char> held, bool grounded);

/// Whether an excess is more than rounding; needs velocity_kinematics().
bool exceeds_rounding(const Tree& tree, double excess);

/// Removes kinetic energy from a tree: first from its joints, which keeps momentum and angular
/// momentum of a free tree, then from its rotation. Needs velocity_kinematics(), and leaves it
/// valid.
/// @param excess  [J]; nothing happens where it is no gain
void remove_kinetic_energy(Tree& tree, Workspace& work, double excess);

/// Removes kinetic energy from all trees of an island, in proportion to theirs.
void remove_kinetic_energy(std::span<Tree* const> trees, Workspace& work, double excess);

/// The energy of all trees, kinetic and potential [J]; needs velocity_kinematics().
double energy(std::span<Tree* const> trees);

}  // namespace ziggurat::dynamics
