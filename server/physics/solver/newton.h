// SPDX-License-Identifier: MIT
#pragma once
// Solvers of the velocity problem of an island; the first of these that converges:
// - Newton's method on the contact law (semi-smooth: Alart and Curnier 1991; S. Hueeber and B.
//   Wohlmuth, Comput. Methods Appl. Mech. Eng. 194, 2005), for small islands;
// - the augmented Lagrangian about the last impulses (R. T. Rockafellar, Math. Oper. Res. 1, 1976):
//   for larger islands at rest; for small ones with a line search, after a continuation or after
//   passes;
// - the interior point method, for larger islands that neither of these nor passes solve;
// - Gauss-Seidel passes alone, for heaps that move, and where a factorisation costs too much: heaps
//   of hundreds.
// All but the last factor one matrix along the contact graph.

#include <algorithm>

#include "physics/solver/block_matrix.h"
#include "physics/solver/contact_law.h"
#include "physics/solver/gauss_seidel.h"

namespace ziggurat::dynamics {

/// Result of a solver.
struct SolverResult {
  int iterations = 0;                  ///< of Newton's method
  int augmented_lagrangian_steps = 0;  ///< steps of the augmented Lagrangian
  int interior_point_steps = 0;        ///< steps of the interior point method
  int passes = 0;                      ///< over all contacts
  double residual = 0;                 ///< worst residual of the contact law [m/s] or [rad/s]
  bool converged = true;
};

/// Velocities of an island before it is solved.
struct InitialVelocities {
  double fastest_contact = 0;  ///< of its contacts [m/s]
  double gravity_change = 0;   ///< by gravity in a substep [m/s]
  /// Whether a contact is faster than forces of one substep make it.
  bool has_impact() const { return fastest_contact > gravity_change; }
};

struct SolverOptions {
  double newton_work = 3e4;      ///< multiplications of a factorisation; more: no Newton's method
  std::size_t few_trees = 8;     ///< number of trees that are no heap:
  double few_trees_factor = 50;  ///< such islands may take so many times more
  int most_iterations = 16;      ///< of Newton's method
  double simplified_newton_residual =
      1e-3;  ///< relative residual from which factors are used again
  int most_stalled_iterations =
      6;  ///< iterations without progress, with a residual above `stalled_residual`
  double stalled_residual = 1e-3;           ///< times the largest speed
  int most_augmented_lagrangian_steps = 8;  ///< full steps of the augmented Lagrangian
  double regularisation = 1e-3;             ///< compliance of its impulses, over the mobility
  int most_interior_point_steps = 40;       ///< steps of the interior point method
  double most_factorisation_work = 1.2e7;   ///< multiplications of a factorisation; more: passes
  double most_impact_work = 2e5;  ///< the same for a heap that is struck, and for displacements of
                                  ///< heaps: their solution is gone in the next substep
  std::size_t most_factored_trees = 300;  ///< of an island whose matrix is analysed
  int most_passes = 60;         ///< of heaps that move, and of islands that are not factored
  double moving_speed = 0.15;   ///< of a heap that moves, at a contact, over gravity_change
  double moving_change = 0.01;  ///< by the last of its passes: of its velocities, over these
  int passes_before_augmented_lagrangian = 20;  ///< before patient steps
  int most_damped_steps = 60;           ///< steps of the augmented Lagrangian with a line search
  int displacement_passes = 60;         ///< of a displacement on which Newton's method fails
  double displacement_residual = 1e-5;  ///< [m], [rad] of it; more: the augmented Lagrangian
  double rounding = 1e-7;               ///< relative residual that counts as rounding
  double relative_tolerance = 1e-9;     ///< of the largest speed or speed change in the island
  double warm_start_tolerance =
      1e-8;  ///< of it, for the momentum residual of the last substep's solution
  double regularised_tolerance = 2e-5;  ///< of it, where Newton's method did not converge
  double most_scale =
      4;  ///< of that speed, over the initial speeds: redundant contacts may balance any impulses
  double absolute_tolerance = 1e-10;  ///< [m/s] or [rad/s]

  /// Multiplications that a factorisation may take.
  double most_work(bool is_struck) const {
    return is_struck ? std::min(most_impact_work, most_factorisation_work)
                     : most_factorisation_work;
  }
  bool suits_newton(std::size_t trees, double work) const {
    return work <= newton_work * (trees <= few_trees ? few_trees_factor : 1);
  }
  double tolerance_of_regularised(const InitialVelocities& beginning, double scale) const {
    const double least = std::max(beginning.fastest_contact, beginning.gravity_change);
    return absolute_tolerance +
           regularised_tolerance * (least > 0 ? std::min(scale, most_scale * least) : scale);
  }
  double tolerance(double scale) const { return absolute_tolerance + relative_tolerance * scale; }
};

/// A constraint in the interior point method, with its present step. Impulse and speed are in units
/// in which a contact's cone is x_0 >= |(x_1, x_2)|.
struct InteriorPointConstraint {
  Vector3 impulse{0, 0, 0}, speed{0, 0, 0}, reference_impulse{0, 0, 0};
  Vector3 scale{0, 0, 0};                 ///< impulses of the constraint over those here
  Vector3 compliance{0, 0, 0};            ///< speed over impulse
  double lower = 0, upper = 0;            ///< of constraints that are not cones
  double lower_dual = 0, upper_dual = 0;  ///< duals of the bounds; 0: no bound
  Matrix3 scaling = Matrix3::Zero(), inverse_scaling = Matrix3::Zero(), hessian = Matrix3::Zero();
  Vector3 scaled_point{0, 0, 0}, slip_gradient{0, 0, 0}, residual{0, 0, 0}, scaled_target{0, 0, 0},
      right_side{0, 0, 0};
  Vector3 impulse_step{0, 0, 0}, speed_step{0, 0, 0};
  double lower_dual_step = 0, upper_dual_step = 0;
};

/// out += J^T impulse of a constraint.
void add_impulse(const Problem& problem, const Constraint& constraint, const double* impulse,
                 std::vector<double>& out);
/// Momentum residual: out := p + J^T g - M v, with the joints' damping in M.
/// @return  the largest residual velocity of a coordinate, about [m/s] or [rad/s]
double momentum_residual(const Problem& problem, std::vector<double>& out);
/// Whether each coordinate's momentum residual is small beside its own impulses.
/// @param missing  see momentum_residual();  @param share  of its impulses;  @param least  absolute
///                 tolerance [m/s] or [rad/s]
/// @param given    memory
bool is_momentum_balanced(const Problem& problem, std::span<const double> residual, double share,
                          double least, std::vector<double>& impulse_sum);

/// Fills a matrix with the mass matrices of a problem, with the joints' damping.
/// @param matrix  of its shape
void assemble_mass(const Problem& problem, BlockMatrix& matrix);

/// Iterate of a solver: velocities and impulses of a problem.
struct Iterate {
  std::vector<double> velocity;                                     ///< of each dof
  std::vector<std::array<double, Constraint::most_rows>> impulses;  ///< of each constraint
  void save(const Problem& problem);
  void restore(Problem& problem) const;
  /// Interpolates a problem's velocities and impulses towards this iterate by a share.
  void backtrack(Problem& problem, double share) const;
};

class VelocitySolver {
 public:
  SolverOptions options;

  /// Solves for problem.velocity and the constraints' impulses, starting from their present values.
  SolverResult solve(Problem& problem);
  /// Solves a displacement problem, less exactly where hundreds of bodies overlap.
  void solve_displacement(Problem& problem);

 private:
  bool newton(Problem& problem, SolverResult& outcome, int most_far);
  bool newton_step(Problem& problem);
  void line_search(Problem& problem, double& wrong);
  void simplified_newton_step(Problem& problem);
  bool simplified_newton(Problem& problem, SolverResult& outcome);
  double analyse(Problem& problem);
  bool is_warm_start_solved(const Problem& problem, SolverResult& outcome);
  void compute_constraint_velocities(const Problem& problem);
  double current_residual(const Problem& problem, double& scale) const;
  bool augmented_lagrangian(Problem& problem, SolverResult& outcome);
  void continuation(Problem& problem, SolverResult& outcome);
  bool damped_augmented_lagrangian(Problem& problem, SolverResult& outcome);
  bool augmented_lagrangian_step(Problem& problem, double regularisation, bool about_multipliers,
                                 double shortest, double& unbalanced);
  bool interior_point(Problem& problem, SolverResult& outcome);
  void enter_cones(const Problem& problem, double margin);
  double linearise_interior_point(Problem& problem);
  double interior_point_direction(Problem& problem, double target, bool corrects);
  double complementarity_after(const Problem& problem, double step_length) const;
  void interior_point_step(Problem& problem, double step_length);
  bool heap_passes(Problem& problem, SolverResult& outcome, bool may_factor);
  bool gauss_seidel(Problem& problem, SolverResult& outcome, int most, double change);
  bool augmented_lagrangian_after_gauss_seidel(Problem& problem, SolverResult& outcome);
  void polish(Problem& problem, SolverResult& outcome);

  BlockMatrix matrix_;
  std::vector<std::array<double, Constraint::most_rows>>
      constraint_velocities_;  // of each constraint, by compute_constraint_velocities()
  std::vector<std::array<double, Constraint::most_rows>> kept_constraint_velocities_;
  std::vector<LinearisedLaw> laws_;
  LinearisedLaw law_;
  std::vector<int> sizes_;
  std::vector<double> hessian_jacobian_;
  std::vector<double> kept_velocity_, multiplier_velocity_;
  InitialVelocities initial_;
  Iterate start_, best_, earlier_;
  std::vector<double> direction_, residual_, impulse_sum_;
  std::vector<InteriorPointConstraint> interior_;
  GaussSeidel gauss_seidel_;
};

/// Solves an island's problem, all of whose constraints are there, for its velocities, without
/// restitution. Limits hold at the bound that the velocities pass.
SolverResult solve_velocities(Problem& problem, VelocitySolver& solver);

}  // namespace ziggurat::dynamics
