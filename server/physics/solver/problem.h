// SPDX-License-Identifier: MIT
#pragma once
// The velocity problem of one island in one substep, for velocities v and impulses g:
//   M v = p + J^T g,   u = J v,   g in the law of (u, g), see contact_law.h.
// M: mass matrices of its trees at the beginning, with the implicit damping of joints. p: momentum
// without the impulses. J: constraint Jacobian, which gives the velocities u at contacts, servos
// and limits.

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "physics/multibody/equations.h"
#include "physics/solver/contact_law.h"
#include "physics/solver/jacobian.h"

namespace ziggurat::dynamics {

struct Problem {
  double time_step = 0;            ///< of the substep [s]
  double compliance_factor = 0;    ///< of surfaces, see StepOptions; 0: they are rigid
  bool has_several_trees = false;  ///< whether more than one tree will be added
  double allowed_overlap = 1e-6;   ///< that become_displacement() leaves [m]
  std::vector<Tree*> trees;        ///< by their index in the system
  std::vector<int> offset;         ///< of each tree in p and v
  std::vector<double> mass;        ///< matrices of all trees, each dofs x dofs
  std::vector<int> mass_offset;    ///< of each tree in `mass`
  std::vector<std::array<double, 6>> root_bias_impulse;  ///< of each tree, see predict_momentum()
  std::vector<double> bias_velocity_change;              ///< of each tree, see Workspace
  std::vector<Constraint> constraints;
  std::vector<double> jacobian;  ///< see Constraint::jacobian_a; as far as jacobian_end
  std::size_t jacobian_end = 0;  ///< end of the rows in `jacobian`
  std::vector<double> momentum;  ///< p
  std::vector<double>
      inverse_mass;  ///< of each dof as if it were alone: 1 / M_kk [1/kg] or [1/(kg m^2)]
  std::vector<Motion>
      bias_acceleration;  ///< of each link of rotating trees, see bias_accelerations()
  std::vector<int> first_bias_acceleration;    ///< of each tree, in `bias_acceleration`; -1: not
                                               ///< needed, or it hardly rotates
  std::vector<double> total_mass;              ///< of each tree [kg]
  double weight = 0;                           ///< of all trees [N]
  std::vector<double> velocity;                ///< v: start and solution
  std::vector<std::pair<int, int>> couplings;  ///< pairs of trees with a common constraint

  void clear();
  /// Adds a tree at the end, with its momentum; its kinematics are valid.
  /// @param is_driven  whether servos hold some of its coordinates
  void add(Tree& tree, Workspace& work, bool is_driven);
  /// Mass matrix of a tree, without the joints' damping, row by row.
  const double* mass_of(std::size_t tree) const { return mass.data() + mass_offset[tree]; }
  /// Adds a constraint between trees of the island, given by their indices.
  void add(const ContactPoint& contact, int a, int b, int source);
  /// @param other  the tree of Servo::other; -1: none
  void add(const Servo& servo, int index, int other, int source);
  /// A limit that may be reached within the substep.
  void add(const Limit& limit, int index, int source);

  /// Velocities u of a constraint at the present solution.
  void constraint_velocity(const Constraint& constraint, double* u) const {
    constraint_velocity(constraint, u, velocity.data());
  }
  /// Velocities u at other velocities v of the dofs.
  void constraint_velocity(const Constraint& constraint, double* u, const double* v) const;
  /// Switches limits to the bound that the present velocities pass.
  /// @return  whether one was switched
  bool switch_limits();
  /// Reduces the compliance of all contacts so that the last substep's impulses penetrate no deeper
  /// than allowed.
  void bound_penetration();
  /// Lets contacts rest that are pressed in as their loads say, but for 1e-4 of the weight: a
  /// correction would be in the next start, which is this solution, and bodies would go back and
  /// forth. To be called after bound_penetration().
  void settle_loads();
  /// Makes all surfaces rigid.
  void make_rigid();
  /// Whether a contact or limit is violated by more than allowed_overlap.
  bool penetrates(const Constraint& constraint) const {
    return constraint.kind != Constraint::Kind::servo && constraint.law != Constraint::Law::off &&
           constraint.gap < -allowed_overlap;
  }
  /// Gap at the substep's end with the present velocities [m], [rad].
  double gap_after(const Constraint& constraint) const;
  /// Whether the present velocities leave a penetration between two trees.
  bool leaves_trees_penetrating() const;

  /// Becomes the problem of the smallest displacement that resolves penetration: v in [m] and
  /// [rad], without momentum and friction.
  /// @return  false if there is no penetration
  bool become_displacement();

 private:
  double* add_rows(int rows, std::size_t dofs, int& first);
  void add_contact_rows(const Tree& tree, int link, const Vector3& point, Constraint& constraint,
                        double sign);
  void add_grip_rows(const Servo& servo, int other, Constraint& constraint);
  void add_coupling(int a, int b);
  void set_row_mobility(Constraint& constraint) const;
  Vector3 point_bias_acceleration(int tree, int link, const Vector3& point,
                                  const ContactPoint& contact) const;
  void set_normal_target(Constraint& constraint, const ContactPoint& contact) const;
  void add_rotation_correction(Constraint& constraint, const ContactPoint& contact) const;
};

/// Turns the start of a single tree, the last substep's solution, about the vertical with it:
/// velocities, and impulses where contacts are level. Gravity and a level floor are the same from
/// all sides, so that solves a steady turn.
void turn_start(Problem& problem);

inline void Problem::constraint_velocity(const Constraint& constraint, double* u,
                                         const double* v) const {
  const double* j = jacobian.data();
  dispatch_rows(constraint.rows, [&](auto rows) {
    for (int r = 0; r < rows(); ++r) u[r] = 0;
    if (constraint.a >= 0)
      add_velocity<rows()>(j + constraint.jacobian_a, constraint.dofs_a, v + offset[constraint.a],
                           u);
    if (constraint.b >= 0)
      add_velocity<rows()>(j + constraint.jacobian_b, constraint.dofs_b, v + offset[constraint.b],
                           u);
  });
}

}  // namespace ziggurat::dynamics
