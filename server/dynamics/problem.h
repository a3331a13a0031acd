#pragma once
// The velocity problem of one island in one substep: velocities v and impulses g with
//   M v = p + J^T g,   u = J v,   g in the contact law of (u, g).
// M: mass matrices of its trees at the beginning, with the implicit damping of joints; p: the
// momentum without the impulses; J: rows that give the speeds u at contacts and servos.

#include <array>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "dynamics/constraint.h"
#include "dynamics/equations.h"

namespace ziggurat::dynamics {

/// The rows of one contact (normal; two tangents; turning about normal and tangents) or servo.
struct Constraint {
  static constexpr int most_rows = 6;
  enum class Law : unsigned char {
    contact,  ///< normal impulse >= 0, friction within its discs
    bounded,  ///< impulse within [lower, upper]
    off       ///< no impulse
  };
  Law law = Law::off;
  int rows = 0;        ///< 1, 3 or 6
  int a = -1, b = -1;  ///< places of the trees in the island, or -1
  int jacobian_a = 0, jacobian_b = 0;  ///< into Problem::jacobian: per dof of the tree, a column of `rows`
  std::span<const int> dofs_a, dofs_b;  ///< that move each side, ascending; other columns are zero
  double friction = 0, spinning_friction = 0, rolling_friction = 0;  ///< bounds over the normal impulse: 1, [m], [m]
  double lower = 0, upper = 0;
  std::array<double, most_rows> target_velocity{};      ///< the speeds that the impulses seek [m/s], [rad/s]
  std::array<double, most_rows> impulse{};   ///< [N s], [N m s]
  std::array<double, most_rows> mobility{};  ///< about what a unit impulse changes of u

  double compliance = 0;  ///< of a contact: the speed into each other that a normal impulse leaves [1/kg]

  std::array<double, most_rows> multiplier{};  ///< of the softened law, see contact_law.h [N s], [N m s]

  double gap = 0;                   ///< of contacts and limits [m] or [rad]
  double gap_acceleration = 0;                  ///< of a contact that turns: by how much faster its surfaces part in a second without forces [m/s^2]
  double range = 0;                 ///< of a limit: between its bounds [m] or [rad]
  double restitution = 0;           ///< of a contact
  bool has_impact = false;             ///< a contact that is met within the substep and rebounds
  double target_gap = 0;                  ///< of one that bounces: the gap at the substep's end [m]
  double restitution_velocity = 0;                ///< and its speed with which the work of the impact is right [m/s]
  double impact_time = 0;                   ///< and when, from the substep's beginning [s]
  Matrix3 frame = Matrix3::Zero();  ///< columns: normal and tangents of a contact
  int source = 0;                   ///< into the contacts, servos or limits of the system
  /// Of a servo: it does not give all that it has.
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
  std::vector<Motion> bias_acceleration;                    ///< of each link of the trees that turn, see bias_accelerations()
  std::vector<int> first_bias_acceleration;                 ///< of each tree, in `bias`; -1: not needed, or it hardly turns
  std::vector<double> total_mass;              ///< of each tree [kg]
  double weight = 0;                           ///< of all trees [N]
  std::vector<double> carried;                 ///< memory of solve_velocities(): what carries each tree, times gravity [N s m/s^2]
  std::vector<Vector3> pressed;                ///< likewise: what contacts gave each tree in the last substep [N s]
  std::vector<double> velocity;                ///< v: start and solution
  bool has_sequential_impacts = false;                        ///< its impacts were taken in the order of time: they say where all of it ends
  std::vector<std::pair<int, int>> couplings;  ///< pairs of trees that meet in a block

  void clear();
  /// Adds a tree at the end, with its momentum; it is placed and moved.
  /// @param is_driven  whether servos hold some of its coordinates
  void add(Tree& tree, Workspace& work, bool is_driven);
  /// Mass matrix of a tree, without the joints' damping, row by row.
  const double* mass_of(std::size_t tree) const { return mass.data() + mass_offset[tree]; }
  /// Places of the trees in the island.
  void add(const ContactPoint& contact, int a, int b, int source);
  void add(const Servo& servo, int index, int source);
  /// A limit that may be reached within the substep.
  void add(const Limit& limit, int index, int source);

  /// Speeds at a block for the present velocities.
  void constraint_velocity(const Constraint& constraint, double* u) const { constraint_velocity(constraint, u, velocity.data()); }
  /// For other velocities, of each dof.
  void constraint_velocity(const Constraint& constraint, double* u, const double* v) const;
  /// Lets limits hold at that of their bounds which the present velocities pass.
  /// @return  whether there is one that held at the other
  bool switch_limits();
  /// Makes all surfaces as much harder as the last substep's impulses need so as not to press them in too far.
  void bound_penetration();
  /// Makes all surfaces rigid.
  void make_rigid();
  /// Of a solved problem: whether a contact was met and rebounded. Between two walls all that it was given may add up to nothing.
  bool rebounded(const Constraint& constraint) const { return constraint.has_impact && (has_sequential_impacts || constraint.impulse[0] > 0); }
  /// Whether a surface is pressed in, or a joint beyond its limit, by more than allowed_overlap.
  bool penetrates(const Constraint& constraint) const { return constraint.kind != Constraint::Kind::servo && constraint.law != Constraint::Law::off && constraint.gap < -allowed_overlap; }
  /// What the present velocities leave of its gap [m], [rad].
  double gap_after(const Constraint& constraint) const;
  /// Whether they leave two trees overlapping that do.
  bool leaves_trees_penetrating() const;

  /// Turns the problem into that of the smallest displacement that undoes overlaps: v in [m] and
  /// [rad], without momentum and friction.
  /// @return  false if there is nothing to undo
  bool become_displacement();
  /// Of such a problem: leaves what rebounds where its velocity takes it, and begins anew.
  void leave_rebounds();

 private:
  int add_columns(const Tree& tree, int rows);
  int add_contact_columns(const Tree& tree, int link, const Vector3& point, const Constraint& constraint, double sign);
  void compute_mobility(Constraint& constraint) const;
  Vector3 point_bias_acceleration(int tree, int link, const Vector3& point, const ContactPoint& contact) const;
  void set_normal_target(Constraint& constraint) const;
  void add_rotation_correction(Constraint& constraint, const ContactPoint& contact) const;
};

/// Calls f with a block's number of rows, as a number that the compiler knows.
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

/// Whether a side's touched dofs begin with the first six of its tree: those of a free root, or of joints on
/// the way from a fixed one.
inline bool begins_with_floating_base(std::span<const int> dofs) { return dofs.size() >= 6 && dofs[5] == 5; }

}  // namespace ziggurat::dynamics
