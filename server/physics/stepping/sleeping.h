// SPDX-License-Identifier: MIT
#pragma once
// Sleep of islands at rest, and events that wake them: an approaching contact, changed wrenches or
// servos.

#include <cstdint>
#include <span>
#include <vector>

#include "physics/multibody/tree.h"
#include "physics/solver/constraint.h"

namespace ziggurat::dynamics {

/// Conditions of sleep. An island sleeps if it touches the world and all its coordinates stay below
/// these velocities for this time. A body that starts to slide on a slope is faster by then.
struct SleepOptions {
  bool enabled = true;
  double linear_velocity = 5e-5;   ///< of what moves [m/s]
  double angular_velocity = 5e-4;  ///< of rotation, and of joints [rad/s] or [m/s]
  double time = 0.3;               ///< [s]
  double force_change = 1e-3;      ///< change that wakes, over weight and force when it fell asleep
  // Conditions for a heap that was solved by passes only, in whose residual slow motion is lost.
  double heap_velocity = 1e-3;  ///< root mean square of all its mass [m/s]
  double heap_fastest = 5e-3;   ///< of a tree [m/s]
  double heap_time = 0.5;       ///< [s]
};

/// Sleep state of a tree.
struct SleepState {
  double time_at_rest = 0;    ///< time below the bounds of sleep [s]
  std::uint64_t command = 0;  ///< hash of its servos' commands
  std::uint64_t command_asleep = 0;
  double force_bound =
      0;                 ///< of changes on a link that do not wake it [N], [N m] per radius of 1 m
  int first_servo = -1;  ///< that it had last, see Sleep::next_servo
  void archive(math::Archive& archive);
};

/// Sleep of all trees.
struct Sleep {
  std::vector<SleepState> states;
  std::vector<int>
      ring;  ///< of each tree: the next in the ring of those that sleep with it; -1: awake
  /// Flags of each tree: its servos have commands, it had wrenches when it fell asleep, or has them
  /// now.
  enum Flag : unsigned char { commanded = 1, loaded_asleep = 2, loaded = 4, subdivided = 8 };
  std::vector<unsigned char> flags;
  std::vector<int> flagged;     ///< trees that have flags, in any order, and some that had them
  std::vector<int> next_servo;  ///< of each servo: the next of its tree; -1: none
  std::vector<int> awake;       ///< trees that are awake, ascending: see list_awake()
  std::size_t tree_count = 0;   ///< of all trees when they were listed
  std::uint64_t changes = 1;    ///< how often a tree fell asleep or woke
  std::uint64_t listed = 0;     ///< `changes` when they were listed

  bool is_asleep(int tree) const {
    return static_cast<std::size_t>(tree) < ring.size() && ring[tree] >= 0;
  }
};

/// Sets a flag of a tree.
void set_flag(Sleep& sleep, int tree, Sleep::Flag flag);

/// Lists the trees that have flags again.
void list_flagged(Sleep& sleep);

/// Lists the awake trees of so many, if some fell asleep, woke, came or went since the last call.
void list_awake(Sleep& sleep, std::size_t trees);

/// Wakes a tree and its island.
void wake(Sleep& sleep, int tree);

/// Wakes all of so many trees.
void wake_all(Sleep& sleep, std::size_t trees);

/// Wakes the sleepers that constraints, wrenches or commands disturb.
/// @param active     trees that take part, ascending; none: all
/// @param time_step  within which a contact may touch [s]
/// @return           whether a tree woke
bool wake_disturbed(Sleep& sleep, const std::vector<Tree>& trees, std::span<const int> active,
                    const ConstraintLists& constraints, double time_step);

/// Whether an island that the world carries is below the bounds of sleep.
/// @param heap_residual  residual of its solution if it was solved by passes only [m/s]; else 0
bool is_quiet(const SleepOptions& options, const std::vector<Tree>& trees,
              std::span<const int> island, double heap_residual);

/// Lets an island sleep that has been quiet for long enough.
/// @param heap_residual  see is_quiet()
void update_sleep(Sleep& sleep, const SleepOptions& options, std::vector<Tree>& trees,
                  std::span<const int> island, double time_step, bool is_quiet,
                  double heap_residual);

/// Calls visit(tree) for all active trees with flags, and for some without.
/// @param active  none: all
template <class Visit>
void for_each_flagged(const Sleep& sleep, std::span<const int> active, Visit visit) {
  for (const int tree : active.empty() ? std::span<const int>(sleep.flagged) : active) visit(tree);
}

}  // namespace ziggurat::dynamics
