#pragma once
// All trees, stepped together. Islands of trees in contact are solved one by one, each from its own
// trees, contacts, servos and limits alone.

#include <cstdint>
#include <span>
#include <vector>

#include "dynamics/prescribed_joints.h"
#include "dynamics/energy_error.h"
#include "dynamics/impact.h"
#include "dynamics/newton.h"
#include "dynamics/geometric_stiffness.h"
#include "dynamics/unconstrained_trees.h"

namespace ziggurat::dynamics {

/// Statistics of a substep.
struct Report {
  int islands = 0;          ///< solved for contacts, servos or limits
  int not_converged = 0;    ///< of them
  int most_iterations = 0;  ///< of Newton's method in an island
  int most_augmented_lagrangian_steps = 0;    ///< of the softened problem
  int most_interior_point_steps = 0;    ///< of the interior point method
  int most_passes = 0;      ///< over the contacts of an island
  double residual = 0;          ///< worst residual of the contact law [m/s] or [rad/s]
  int awake = 0;            ///< trees that moved
  int most_evaluations = 0;     ///< of the equations of motion of a tree in free motion
  int most_evaluated_tree = -1;  ///< the first tree with so many
};

/// A tree on a fixed base that rotates far until its next impact.
struct RotationUntilImpact {
  int tree = 0;
  double angle = 0;  ///< [rad]
};

/// Islands that a step left unchanged, because a link swings or nutates too fast for it, or because it has an impact.
struct IslandsToSubdivide {
  struct Island {
    int parts = 0;                    ///< number of parts of the step; 0: it ends at the impact
    double impact_time = 0;           ///< of the first impact, from the step's beginning [s]
    std::size_t first = 0, last = 0;  ///< in `trees`
  };
  std::vector<Island> islands;
  std::vector<int> trees;  ///< ascending in each island

  void add(std::span<const int> of_island, int parts, double impact_time = 0);
};

/// Trees, and their predicted velocities at a substep's end.
struct PredictedVelocities {
  std::vector<int> trees;
  std::vector<double> velocities;  ///< of each dof of each tree, in their order
};

/// Exchanges the trees' velocities with the predicted ones.
void swap_velocities(std::vector<Tree>& trees, PredictedVelocities& foresight);

/// Conditions of sleep. An island sleeps if it touches the world and all its coordinates stay below
/// these velocities for this time. A body that starts to slide on a slope is faster by then.
struct SleepOptions {
  bool enabled = true;
  double linear_velocity = 5e-5;    ///< of what moves [m/s]
  double angular_velocity = 5e-4;  ///< of rotation, and of joints [rad/s] or [m/s]
  double time = 0.3;      ///< [s]
  double force_change = 1e-3;    ///< change that wakes, over weight and force when it fell asleep
  // Conditions for a heap that was solved by passes only, in whose residual slow motion is lost.
  double heap_velocity = 1e-3;    ///< root mean square of all its mass [m/s]
  double heap_fastest = 5e-3;  ///< of a tree [m/s]
  double heap_time = 0.5;      ///< [s]
};

/// The two trees of a contact; -1: the world. A ContactPoint takes far more of the cache.
struct ContactTrees {
  int a = -1, b = -1;
};
void list_contact_trees(std::span<const ContactPoint> contacts, std::vector<ContactTrees>& out);

class System {
 public:
  std::vector<Tree> trees;
  SleepOptions sleeping;
  /// Compliance of contacts: closing velocity over the velocity change of both bodies by the normal
  /// impulse; 0: rigid. It shares loads among redundant contacts.
  double compliance_factor = default_compliance_factor;
  static constexpr double default_compliance_factor = 5e-5;
  double allowed_overlap = 1e-6;  ///< penetration that remains, because rounding must not move bodies [m]
  /// Largest number of parts that step() may ask for, see geometric_stiffness.h and
  /// gyroscopic_stiffness.h. 1: none.
  int most_parts = 1;
  ImpactMode impact_mode = ImpactMode::inelastic;
  IslandsToSubdivide islands_to_subdivide;      ///< by the last step()
  /// Trees whose rotation until impact is large: their islands are divided, because a contact acts
  /// along lines of the step's beginning. To be set before step().
  std::vector<RotationUntilImpact> rotations_until_impact;

  /// Whether a tree sleeps. Then a substep leaves it as it is, and ignores its contacts, until its
  /// island wakes: by an approaching contact, a change of its wrenches or servos, or wake().
  bool is_asleep(int tree) const {
    return static_cast<std::size_t>(tree) < sleep_ring_.size() && sleep_ring_[tree] >= 0;
  }
  /// Wakes a tree and its island: to be called when its pose, velocity or gravity was set, or a
  /// body that it touches was moved or removed.
  void wake(int tree);
  /// Wakes all trees; must be called when trees were removed or renumbered.
  void wake_all();

  /// Adds to a link's external wrench for the coming substep. A sleeper ignores wrenches set
  /// otherwise.
  void apply_wrench(int tree, int link, const Wrench& wrench);

  /// Takes the constraints of the coming substep, see step(), and wakes the sleepers that they
  /// disturb. To be called before advance(), and again when contacts of sleepers were added.
  /// @return  whether a tree woke
  bool wake_disturbed(double time_step, std::span<ContactPoint> contacts, std::span<Servo> servos, std::span<const int> chosen = {});

  /// Predicts velocities of trees that motors, wrenches or impacts accelerate within the coming
  /// substep: their present velocities do not tell their contacts. To be called after
  /// wake_disturbed(), whose contacts, servos and trees it takes.
  /// @param far   distance within the substep below which a change is ignored [m]
  /// @param fast  all trees that may come half as far already: impacts and limits may deflect them
  /// @return      whether there are some
  bool predict_velocities(std::span<Limit> limits, double far, std::span<const int> fast, PredictedVelocities& out);

  /// Advances all trees that are awake by one substep. Their external wrenches must be set.
  /// @param time_step [s]
  /// The order of contacts in the list does not matter: in an island they are sorted by trees,
  /// links and places.
  /// @param contacts  those between two trees that stand on the world do nothing; impulses are
  ///                  read and written
  /// @param limits    of joints whose trees are awake
  /// @param chosen    trees that take part, ascending; the others stay as they are, and nothing may
  ///                  act between them and these. Empty: all do
  Report step(double time_step, std::span<ContactPoint> contacts, std::span<Servo> servos = {},
              std::span<Limit> limits = {}, std::span<const int> chosen = {});

  /// Advances by one substep with the constraints of wake_disturbed().
  Report advance(std::span<Limit> limits);

  /// Applies the impact law to touching contacts that approach: velocities change, positions stay.
  /// @param contacts, servos, limits  in: as in step(); servos with the bounds of what they may give at once; out: impulses
  void apply_impacts(std::span<ContactPoint> contacts, std::span<Servo> servos, std::span<Limit> limits,
                     std::span<const int> chosen);

  /// Resolves penetration without changing velocities: for overlaps that are found after a substep.
  /// @param contacts  of trees that are awake; their impulses do not matter
  /// @param chosen    as in step(): no others have contacts
  void separate(std::span<ContactPoint> contacts, std::span<const int> chosen = {});

  VelocitySolver& solver() { return solver_; }

  /// State of all trees and their sleep. Between two substeps, without wrenches.
  void archive(math::Archive& archive);

 private:
  enum Kind { contact_item, servo_item, limit_item };
  struct IslandItem {
    int island;
    Kind kind;
    int index;
  };
  template <class Visit>
  void for_each_active(Visit visit) const;
  bool has_changed_load(int tree) const;
  void clear_wrenches();
  bool comes_to_touch(const ContactPoint& contact) const;
  void hash_servo_commands();
  void update_sleep(int first_tree, int last_tree, bool carried, double heap_residual = 0);
  void list_awake();
  void build_islands();
  void prefetch_after(std::size_t island) const;
  void assemble_problem(int first_tree, int last_tree, int first_item, int last_item);
  void solve_island(int first_tree, int last_tree, int first_item, int last_item);
  bool violates_limit(int first_item, int last_item, int of = -1) const;
  bool integrate_free_island(int first_tree, int last_tree, int first_item, int last_item);
  bool integrate_free_trees(int first_tree, int last_tree, int first_item, int last_item);

  /// Sleep state of a tree.
  struct SleepState {
    double time_at_rest = 0;           // time below the bounds of sleep [s]
    std::uint64_t command = 0;  // of its servos, see hash_servo_commands()
    std::uint64_t command_asleep = 0;
    double force_bound = 0;  // of changes on a link [N], [N m] per radius of 1 m
    int first_servo = -1;    // that it had last, see next_servo_
    void archive(math::Archive& archive);
  };
  std::vector<SleepState> sleep_states_;
  std::vector<int>
      sleep_ring_;  // of each tree: the next in the ring of those that sleep with it; -1: awake
  // Flags of each tree: its servos have commands, it had wrenches when it fell asleep, or has them
  // now. Within a step also: it was left for parts of the step.
  enum WakeFlag : unsigned char { commanded = 1, loaded_asleep = 2, loaded = 4, subdivided = 8 };
  std::vector<unsigned char> wake_flags_;
  std::vector<int> awake_, disturbed_;
  std::vector<unsigned char> is_fast_;  ///< of each tree: an impact may deflect it
  std::vector<ContactTrees> contact_trees_;  // of contacts_
  double time_step_ = 0;
  std::span<ContactPoint> contacts_;
  std::span<Servo> servos_;
  std::vector<int> next_servo_;  // of each servo: the next of its tree; -1: none
  std::span<Limit> limits_;
  std::span<const int> active_;
  Report report_;

  std::vector<int> parent_, island_, index_in_island_;
  std::vector<int> first_tree_, tree_order_, first_item_;
  std::vector<IslandItem> items_, item_order_;
  std::vector<unsigned char> has_servos_, is_free_;  // of each tree of an island
  UnconstrainedVelocities free_velocities_;
  std::vector<double> saved_state_, displacement_;
  IslandEnergyErrors energy_errors_;
  ImpactMemory impact_memory_;
  GeometricStiffness geometric_stiffness_;
  IslandPrescribedJoints prescribed_joints_;
  Workspace work_;
  Problem problem_;
  VelocitySolver solver_;
};

/// Calls visit(tree) in ascending order.
template <class Visit>
void System::for_each_active(Visit visit) const {
  if (!active_.empty()) {
    for (const int tree : active_) visit(tree);
  } else {
    for (int tree = 0; tree < static_cast<int>(trees.size()); ++tree) visit(tree);
  }
}

}  // namespace ziggurat::dynamics
