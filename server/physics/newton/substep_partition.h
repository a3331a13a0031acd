#pragma once
// Partition of trees by the number of parts of their substep. Stiff pairs, whose forces change too
// fast for a whole substep, take parts, with all trees that they may touch meanwhile.

#include <span>
#include <vector>

#include "physics/newton/colliders.h"
#include "physics/newton/tree_set.h"
#include "physics/plugin.h"

namespace ziggurat::physics {

class SubstepPartition {
 public:
  /// Partitions the trees of a substep.
  /// @param pairs  the stiff ones
  /// @param near   colliders that may touch within the substep
  /// @param contacts  likewise, of trees that have just woken
  void partition(std::span<const StiffPair> pairs, std::span<const ColliderPair> near,
            std::span<const dynamics::ContactPoint> contacts, const std::vector<Collider>& colliders,
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

}  // namespace ziggurat::physics
