// SPDX-License-Identifier: MIT
#pragma once
// Step of one island: free motion, or motion by the solution of its velocity problem, with the
// corrections of its end.

#include <span>
#include <vector>

#include "physics/solver/newton.h"
#include "physics/stepping/energy_error.h"
#include "physics/stepping/geometric_stiffness.h"
#include "physics/stepping/impact.h"
#include "physics/stepping/islands.h"
#include "physics/stepping/unconstrained_trees.h"
#include "timing/stopwatch.h"

namespace ziggurat::dynamics {

/// Statistics of a step.
struct Report {
  int islands = 0;          ///< solved for contacts, servos or limits
  int not_converged = 0;    ///< of them
  int most_iterations = 0;  ///< of Newton's method in an island
  int most_augmented_lagrangian_steps = 0;
  int most_interior_point_steps = 0;
  int most_passes = 0;           ///< over the contacts of an island
  double residual = 0;           ///< worst residual of the contact law [m/s] or [rad/s]
  int awake = 0;                 ///< trees that moved
  int most_evaluations = 0;      ///< of the equations of motion of a tree in free motion
  int most_evaluated_tree = -1;  ///< the first tree with so many
};

/// Adds the statistics of an island that follows.
void add(const Report& island, Report& all);

/// Options of a step.
struct StepOptions {
  static constexpr double default_compliance_factor = 5e-5;
  /// Compliance of contacts: closing velocity over the velocity change of both bodies by the normal
  /// impulse; 0: rigid. It shares loads among redundant contacts.
  double compliance_factor = default_compliance_factor;
  double allowed_overlap =
      1e-6;  ///< penetration that remains, because rounding must not move bodies [m]
  /// Largest number of parts that a step may ask for, see geometric_stiffness.h and
  /// gyroscopic_stiffness.h. 1: none.
  int most_parts = 1;
  ImpactMode impact_mode = ImpactMode::inelastic;
};

/// A tree on a fixed base that rotates far until its next impact.
struct RotationUntilImpact {
  int tree = 0;
  double angle = 0;  ///< [rad]
};

/// Memory of the stages of an island's step; the next island uses it again.
struct alignas(64) IslandMemory {
  Workspace work;
  Problem problem;
  VelocitySolver solver;
  ImpactMemory impact;
  std::vector<unsigned char> has_servos, is_free;  ///< of each tree of the island
  UnconstrainedVelocities free_velocities;
  IslandPrescribedJoints prescribed_joints;
  GeometricStiffness geometric_stiffness;
  IslandEnergyErrors energy_errors;
  std::vector<double> saved_state, displacement;
  timing::Stopwatch watch;  ///< of the stages of its islands
};

/// An island in a step.
struct IslandStep {
  std::vector<Tree>& trees;
  const Islands& islands;
  Island island;
  const ConstraintLists& constraints;  ///< their impulses are read and written
  std::span<const RotationUntilImpact> rotations_until_impact;
  StepOptions options;
  double time_step = 0;  ///< [s]
  IslandMemory& memory;
  Report& report;
  timing::Stopwatch* watch = nullptr;  ///< gets the times of solve and integrate; null: none
};

/// Outcome of an island's step. It is left unchanged if it is to be divided.
struct IslandOutcome {
  int parts = 1;             ///< number of parts of the step; 0: it ends at the impact
  double impact_time = 0;    ///< of the first impact, from the step's beginning [s]
  bool is_carried = false;   ///< the world supports it, and no motor moves it
  double heap_residual = 0;  ///< of a heap that was solved by passes only [m/s]; else 0
  bool is_left() const { return parts != 1; }
};

/// Assembles the velocity problem of an island.
void assemble_problem(const IslandStep& step);

/// Writes the impulses of a solution to contacts, servos and limits, in world axes.
void write_impulses(const Problem& problem, const ConstraintLists& constraints);

/// Advances an island by a step.
IslandOutcome step_island(const IslandStep& step);

/// Applies the impact law to touching contacts that approach: velocities change, positions stay.
void apply_impacts(const IslandStep& step);

/// Resolves penetration without changing velocities, but for the energy that it would give.
void separate(const IslandStep& step);

}  // namespace ziggurat::dynamics
