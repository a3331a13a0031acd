#pragma once
// The velocity problem of one island in one substep, for velocities v and impulses g:
//   M v = p + J^T g,   u = J v,   g in the contact law of (u, g).
// M: mass matrices of its trees at the beginning, with the implicit damping of joints. p: momentum
// without the impulses. J: constraint Jacobian, which gives the velocities u at contacts, servos
// and limits.

#include <array>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "physics/solver/constraint.h"
#include "physics/multibody/equations.h"

namespace ziggurat::dynamics {

/// Rows of one contact (normal; two tangents; rotation about normal and tangents), servo or limit.
struct Constraint {
  static constexpr int most_rows = 6;
  enum class Law : unsigned char {
    contact,  ///< normal impulse >= 0, friction within its discs
    bounded,  ///< impulse within [lower, upper]
    off       ///< no impulse
  };
  Law law = Law::off;
  int rows = 0;        ///< 1, 3 or 6
  int a = -1, b = -1;  ///< indices of the trees in the island, or -1
  int jacobian_a = 0, jacobian_b = 0;  ///< into Problem::jacobian: per dof of the tree, a column of `rows`
  std::span<const int> dofs_a, dofs_b;  ///< that move each side, ascending; other columns are zero
  double friction = 0, spinning_friction = 0, rolling_friction = 0;  ///< bounds over the normal impulse: 1, [m], [m]
  double lower = 0, upper = 0;
  std::array<double, most_rows> target_velocity{};      ///< the velocities that impulses drive to [m/s], [rad/s]
  std::array<double, most_rows> impulse{};   ///< [N s], [N m s]
  std::array<double, most_rows> mobility{};  ///< velocity change by a unit impulse, without coupling of dofs

  double compliance = 0;  ///< of a contact: closing velocity that a normal impulse leaves [1/kg]

  std::array<double, most_rows> multiplier{};  ///< of the regularised law, see contact_law.h [N s], [N m s]

  double gap = 0;                   ///< of contacts and limits [m] or [rad]
  double gap_acceleration = 0;                  ///< of a contact that rotates: the gap's second derivative without forces [m/s^2]
  double range = 0;                 ///< of a limit: distance of its bounds [m] or [rad]
  double restitution = 0;           ///< of a contact
  Matrix3 frame = Matrix3::Zero();  ///< columns: normal and tangents of a contact
  int source = 0;                   ///< into the contacts, servos or limits of the system
  /// Whether a servo's impulse is strictly within its bounds: then it reaches its target velocity.
  bool is_unsaturated() const { return lower < impulse[0] && impulse[0] < upper; }
  enum class Kind : unsigned char { contact, servo, limit } kind = Kind::contact;
};

struct Problem {
  double time_step = 0;                         ///< of the substep [s]
  double compliance_factor = 0;                       ///< of surfaces, see System; 0: they are rigid
  bool has_several_trees = false;                      ///< whether more than one tree will be added
  double allowed_overlap = 1e-6;             ///< that become_displacement() leaves [m]
  std::vector<Tree*> trees;                  ///< by their index in the system
  std::vector<int> offset;                   ///< of each tree in p and v
  std::vector<double> mass;                  ///< matrices of all trees, each dofs x dofs
  std::vector<int> mass_offset;              ///< of each tree in `mass`
  std::vector<std::array<double, 6>> root_bias_impulse;  ///< of each tree, see predict_momentum()
  std::vector<double> bias_velocity_change;               ///< of each tree, see Workspace
  std::vector<Constraint> constraints;
  std::vector<double> jacobian;
  std::vector<double> momentum;  ///< p
  std::vector<double>
      inverse_mass;  ///< of each dof as if it were alone: 1 / M_kk [1/kg] or [1/(kg m^2)]
  std::vector<Motion> bias_acceleration;                    ///< of each link of rotating trees, see bias_accelerations()
  std::vector<int> first_bias_acceleration;                 ///< of each tree, in `bias_acceleration`; -1: not needed, or it hardly rotates
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
  void add(const Servo& servo, int index, int source);
  /// A limit that may be reached within the substep.
  void add(const Limit& limit, int index, int source);

  /// Velocities u of a constraint at the present solution.
  void constraint_velocity(const Constraint& constraint, double* u) const { constraint_velocity(constraint, u, velocity.data()); }
  /// Velocities u at other velocities v of the dofs.
  void constraint_velocity(const Constraint& constraint, double* u, const double* v) const;
  /// Switches limits to the bound that the present velocities pass.
  /// @return  whether one was switched
  bool switch_limits();
  /// Reduces the compliance of all contacts so that the last substep's impulses penetrate no deeper
  /// than allowed.
  void bound_penetration();
  /// Makes all surfaces rigid.
  void make_rigid();
  /// Whether a contact or limit is violated by more than allowed_overlap.
  bool penetrates(const Constraint& constraint) const { return constraint.kind != Constraint::Kind::servo && constraint.law != Constraint::Law::off && constraint.gap < -allowed_overlap; }
  /// Gap at the substep's end with the present velocities [m], [rad].
  double gap_after(const Constraint& constraint) const;
  /// Whether the present velocities leave a penetration between two trees.
  bool leaves_trees_penetrating() const;

  /// Becomes the problem of the smallest displacement that resolves penetration: v in [m] and
  /// [rad], without momentum and friction.
  /// @return  false if there is no penetration
  bool become_displacement();

 private:
  int add_columns(const Tree& tree, int rows);
  int add_contact_columns(const Tree& tree, int link, const Vector3& point, const Constraint& constraint, double sign);
  void compute_mobility(Constraint& constraint) const;
  Vector3 point_bias_acceleration(int tree, int link, const Vector3& point, const ContactPoint& contact) const;
  void set_normal_target(Constraint& constraint) const;
  void add_rotation_correction(Constraint& constraint, const ContactPoint& contact) const;
};

/// Calls f with a constraint's number of rows as a compile-time constant.
template <class F>
void dispatch_rows(int rows, F f) {
  switch (rows) {
    case 1:
      return f(std::integral_constant<int, 1>());
    case 3:
      return f(std::integral_constant<int, 3>());
    default:
      return f(std::integral_constant<int, Constraint::most_rows>());
  }
}

/// Whether a side's dofs begin with the first six of its tree: those of a floating base, or of the
/// first joints of a fixed one.
inline bool begins_with_floating_base(std::span<const int> dofs) { return dofs.size() >= 6 && dofs[5] == 5; }

}  // namespace ziggurat::dynamics
