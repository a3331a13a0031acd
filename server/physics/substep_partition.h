// SPDX-License-Identifier: MIT
#pragma once
// Partition of trees by the number of parts of their substep. Stiff pairs, whose forces change too
// fast for a whole substep, take parts, with all trees that they may touch meanwhile.

#include <span>
#include <vector>

#include "physics/collision/colliders.h"
#include "physics/collision/pair_lists.h"
#include "physics/plugin.h"
#include "physics/stepping/system.h"

namespace ziggurat::physics {

class SubstepPartition {
 public:
  /// Partitions the trees of a substep.
  /// @param pairs  the stiff ones
  /// @param near   colliders that may touch within the substep
  /// @param contacts  likewise, of trees that have just woken
  /// @param servos    those between two trees keep them together
  void partition(std::span<const StiffPair> pairs, std::span<const ColliderPair> near,
                 std::span<const dynamics::ContactPoint> contacts,
                 std::span<const dynamics::Servo> servos, const std::vector<Collider>& colliders,
                 const std::vector<dynamics::Tree>& trees);

  bool is_divided(int tree) const { return parts_[tree] > 0; }
  /// Numbers of parts that occur: ascending, each once.
  const std::vector<int>& part_counts() const { return part_counts_; }
  /// Trees with this number of parts; 0: with a whole substep. Valid until the next call.
  const TreeSet& trees_with(int count);

 private:
  int partition(int tree);

  std::vector<int> leader_, parts_, part_counts_;  // the first two of each tree
  TreeSet active_;
};

/// Time of each tree's velocities relative to its positions.
struct LeapfrogSync {
  enum VelocityTime : unsigned char {
    unknown,           ///< it had a contact or a servo, or is new
    half_step_before,  ///< of half a substep before
    same_time          ///< of now
  };
  std::vector<unsigned char> of_tree, is_constrained;  ///< the second is working memory
};

/// Shifts velocities by half a step's impulse where a tree in free motion changes between both
/// methods, which conserves its energy. Whole substeps apply forces at their beginning, so
/// velocities are those of half a substep before. Leapfrog steps end with velocities of the same
/// time. To be called before a substep, with its external wrenches.
void synchronise_velocities(LeapfrogSync& lags, dynamics::System& system, dynamics::Workspace& work,
                            double time_step, const SubstepPartition* division,
                            std::span<const dynamics::ContactPoint> contacts,
                            std::span<const dynamics::Servo> servos);

}  // namespace ziggurat::physics
