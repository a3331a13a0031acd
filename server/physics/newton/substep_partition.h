#pragma once
// Which trees take a substep in parts, because forces between them change too fast for it: those of
// stiff pairs, and all that they may touch meanwhile.

#include <span>
#include <vector>

#include "physics/newton/colliders.h"
#include "physics/newton/tree_set.h"
#include "physics/plugin.h"

namespace ziggurat::physics {

class SubstepPartition {
 public:
  /// @param pairs  the stiff ones
  /// @param near   colliders that may touch within the substep
  /// @param contacts  likewise, of those that have just woken
  void partition(std::span<const StiffPair> pairs, std::span<const ColliderPair> near,
            std::span<const dynamics::ContactPoint> contacts, const std::vector<Collider>& colliders,
            const std::vector<dynamics::Tree>& trees);

  bool is_divided(int tree) const { return parts_[tree] > 0; }
  /// Into how many parts the sets of trees divide the substep: ascending, each once.
  const std::vector<int>& part_counts() const { return part_counts_; }
  /// The trees whose substep has so many parts; 0: that take it as a whole. Valid until the next
  /// call.
  const TreeSet& trees_with(int count);

 private:
  int partition(int tree);

  std::vector<int> leader_, parts_, part_counts_;  // the first two of each tree
  TreeSet active_;
};

}  // namespace ziggurat::physics
