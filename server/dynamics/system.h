#pragma once
// All trees, stepped together: islands of trees that touch are solved one by one, each from its own
// trees, contacts, servos and limits alone.

#include <cstdint>
#include <span>
#include <vector>

#include "dynamics/prescribed_joints.h"
#include "dynamics/energy_error.h"
#include "dynamics/newton.h"
#include "dynamics/restitution_energy.h"
#include "dynamics/geometric_stiffness.h"
#include "dynamics/unconstrained_trees.h"

namespace ziggurat::dynamics {

/// What became of a substep.
struct Report {
  int islands = 0;          ///< solved for contacts, servos or limits
  int not_converged = 0;    ///< of them
  int most_iterations = 0;  ///< of Newton's method in an island
  int most_descents = 0;    ///< of the softened problem
  int most_interior = 0;    ///< of the interior point method
  int most_sweeps = 0;      ///< over the contacts of an island
  double miss = 0;          ///< worst violation of the contact law [m/s] or [rad/s]
  int awake = 0;            ///< trees that moved
};

/// A tree that swings far until it meets something.
struct Swing {
  int tree = 0;
  double angle = 0;  ///< [rad]
};

/// Islands that a step left as they were, because something in them swings or nutates too fast for it.
struct LeftIslands {
  struct Island {
    int parts = 0;                    ///< into which the step should be divided for it
    std::size_t first = 0, last = 0;  ///< in `trees`
  };
  std::vector<Island> islands;
  std::vector<int> trees;  ///< ascending in each island

  void add(std::span<const int> of_island, int parts);
};

/// Trees, and the speeds that they will have at a substep's end, as far as is known what they meet.
struct Foresight {
  std::vector<int> trees;
  std::vector<double> speeds;  ///< of each dof of each tree, in their order
};

/// Gives these trees the other speeds, and back.
void swap_speeds(std::vector<Tree>& trees, Foresight& foresight);

/// What makes an island sleep. It must touch the world, and all its coordinates must stay this slow
/// for this time: a body on a slope that starts to move is faster by then.
struct RestOptions {
  bool sleeps = true;
  double speed = 5e-5;    ///< of what moves [m/s]
  double turning = 5e-4;  ///< of what turns, and of joints [rad/s] or [m/s]
  double time = 0.3;      ///< [s]
  double force = 1e-3;    ///< change that wakes, over the weight and the force at the time of sleep
  // A heap that was swept: what is slower than its solution misses the law by is not known to move.
  double swept_speed = 1e-3;    ///< of all its mass, root mean square: it may be no more [m/s]
  double swept_fastest = 5e-3;  ///< of a tree [m/s]
  double swept_time = 0.5;      ///< [s]
};

/// Between which trees a contact is; -1: the world. Contacts take far more of the cache.
struct Ends {
  int a = -1, b = -1;
};
void note_ends(std::span<const Contact> contacts, std::vector<Ends>& out);

class System {
 public:
  std::vector<Tree> trees;
  RestOptions rest;
  /// A contact gives way by the speed that its normal impulse gives both bodies, times this; 0: not at all. So loads
  /// are shared where there are more contacts than needed.
  double softness = usual_softness;
  static constexpr double usual_softness = 5e-5;
  double allowed_overlap = 1e-6;  ///< it may remain, because rounding must not move bodies [m]
  /// Into how many parts step() may ask to divide itself for an island, see geometric_stiffness.h and gyroscopic_stiffness.h. 1: it may not.
  int most_parts = 1;
  bool is_part = false;  ///< step() takes one of these parts
  LeftIslands left;      ///< by the last step()
  /// Those whose islands take parts, too: a contact acts along lines of the step's beginning. To be set before step().
  std::vector<Swing> swings;

  /// Whether a tree sleeps. Then a substep leaves it as it is; its contacts need not be told, and
  /// are ignored, until something wakes its island: a contact with a tree that is awake and comes
  /// to touch it, a change of what pushes it or of its servos, or wake().
  bool asleep(int tree) const {
    return static_cast<std::size_t>(tree) < next_.size() && next_[tree] >= 0;
  }
  /// Wakes a tree and what sleeps with it: to be called when it was moved, its speed or gravity was
  /// set, or what it touches was moved or removed.
  void wake(int tree);
  /// Must be called when trees were removed or changed places.
  void wake_all();

  /// Adds to a link's external wrench for the coming substep. What sleeps notices no other.
  void push(int tree, int link, const Wrench& wrench);

  /// Takes what acts in the coming substep, see step(), and wakes what that would not leave at rest.
  /// To be called before advance(), again with more contacts where those of sleepers are told only
  /// if something wakes.
  /// @return  whether something did
  bool wake_disturbed(double length, std::span<Contact> contacts, std::span<Servo> servos, std::span<const int> chosen = {});

  /// Which trees the coming substep sets in motion within it: by motors, pushes or blows, so that their speeds at its beginning do not
  /// say what they meet. To be called after wake_disturbed(), whose contacts, servos and trees it takes.
  /// @param far   what need not be known: how far such a tree comes in the substep [m]
  /// @param fast  all trees that may come half as far already: what strikes them, or their limits, may throw them and others elsewhere
  /// @return      whether there are some
  bool foresee(std::span<Limit> limits, double far, std::span<const int> fast, Foresight& out);

  /// Advances all trees that are awake by one substep. Their external wrenches must be set.
  /// @param length    [s]
  /// The order of contacts in the list does not matter: in an island they are sorted by trees,
  /// links and places.
  /// @param contacts  those between two trees that stand on the world do nothing; impulses are
  ///                  read and written
  /// @param limits    of joints whose trees are awake
  /// @param chosen    trees that take part, ascending; the others stay as they are, and nothing may
  ///                  act between them and these. Empty: all do
  Report step(double length, std::span<Contact> contacts, std::span<Servo> servos = {},
              std::span<Limit> limits = {}, std::span<const int> chosen = {});

  /// The same with what wake_disturbed() has taken.
  Report advance(std::span<Limit> limits);

  /// Moves apart what overlaps, without speed: for overlaps that are found after a substep.
  /// @param contacts  of trees that are awake; their impulses do not matter
  /// @param chosen    as in step(): no others have contacts
  void push_apart(std::span<Contact> contacts, std::span<const int> chosen = {});

  Solver& solver() { return solver_; }

  /// The state of all trees, and which sleep. Between two substeps, when nothing pushes.
  void archive(math::Archive& archive);

 private:
  enum Kind { contact_item, servo_item, limit_item };
  struct Item {
    int island;
    Kind kind;
    int index;
  };
  template <class Visit>
  void each_that_takes_part(Visit visit) const;
  bool changed(int tree) const;
  void forget_pushes();
  bool comes_to_touch(const Contact& contact) const;
  void note_commands();
  void settle(int first_tree, int last_tree, bool carried, double swept_miss = 0);
  void find_awake();
  void gather();
  void fetch_after(std::size_t island) const;
  void gather_island(int first_tree, int last_tree, int first_item, int last_item);
  void solve_island(int first_tree, int last_tree, int first_item, int last_item);
  bool is_beyond(int first_item, int last_item, int of = -1) const;
  bool fly_island(int first_tree, int last_tree, int first_item, int last_item);
  bool fly_free(int first_tree, int last_tree, int first_item, int last_item);

  /// What is known of a tree's sleep.
  struct Sleeper {
    double quiet = 0;           // how long it has been at rest [s]
    std::uint64_t command = 0;  // of its servos, see note_commands()
    std::uint64_t command_asleep = 0;
    double force_bound = 0;  // of changes on a link [N], [N m] per radius of 1 m
    int first_servo = -1;    // that it had last, see next_servo_
    void archive(math::Archive& archive);
  };
  std::vector<Sleeper> sleepers_;
  std::vector<int>
      next_;  // of each tree: the next in the ring of those that sleep with it; -1: awake
  // Of each tree: whether more than being touched may wake it. It is commanded, was pushed when it
  // fell asleep, or is pushed now. And, within a step, whether that left it as it was.
  enum Watch : unsigned char { commanded = 1, held = 2, pushed = 4, waits = 8 };
  std::vector<unsigned char> watch_;
  std::vector<int> awake_, disturbed_;
  std::vector<unsigned char> fast_;  ///< of each tree: what strikes it may throw it elsewhere
  std::vector<Ends> ends_;  // of contacts_
  double length_ = 0;
  std::span<Contact> contacts_;
  std::span<Servo> servos_;
  std::vector<int> next_servo_;  // of each servo: the next of its tree; -1: none
  std::span<Limit> limits_;
  std::span<const int> chosen_;
  Report report_;

  std::vector<int> parent_, island_, place_;
  std::vector<int> first_tree_, tree_order_, first_item_;
  std::vector<Item> items_, item_order_;
  std::vector<unsigned char> driven_, free_;  // of each tree of an island
  FreeVelocities free_velocities_;
  std::vector<int> only_;  // memory of a function
  std::vector<double> kept_, step_;
  Excesses excesses_;
  Rebound rebound_;
  Tension tension_;
  Drives drives_;
  Workspace work_;
  Problem problem_;
  Solver solver_;
};

/// Calls visit(tree) in ascending order.
template <class Visit>
void System::each_that_takes_part(Visit visit) const {
  if (!chosen_.empty()) {
    for (const int tree : chosen_) visit(tree);
  } else {
    for (int tree = 0; tree < static_cast<int>(trees.size()); ++tree) visit(tree);
  }
}

}  // namespace ziggurat::dynamics
