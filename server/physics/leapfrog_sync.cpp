// SPDX-License-Identifier: MIT
#include <utility>

#include "physics/multibody/free_motion.h"
#include "physics/substep_partition.h"

namespace ziggurat::physics {

void synchronise_velocities(LeapfrogSync& lags, dynamics::System& system, dynamics::Workspace& work,
                            double time_step, const SubstepPartition* division,
                            std::span<const dynamics::ContactPoint> contacts,
                            std::span<const dynamics::Servo> servos) {
  static_assert(LeapfrogSync::unknown == 0);
  const auto is_unknown = [](unsigned char lag) { return lag == LeapfrogSync::unknown; };
  unsigned char any = 0;  // without a branch, many at once
  for (const unsigned char lag : lags.of_tree) any |= lag;
  if (!division && is_unknown(any)) return;
  lags.is_constrained.assign(lags.of_tree.size(), 0);
  const auto mark = [&](int tree) {
    if (tree >= 0) lags.is_constrained[static_cast<std::size_t>(tree)] = 1;
  };
  for (const dynamics::ContactPoint& contact : contacts) mark(contact.a.tree), mark(contact.b.tree);
  for (const dynamics::Servo& servo : servos) mark(servo.tree), mark(servo.other.tree);
  for (std::size_t i = 0; i < lags.of_tree.size(); ++i) {
    const int tree = static_cast<int>(i);
    const bool is_divided = division && division->is_divided(tree);
    const unsigned char now = lags.is_constrained[i] || system.is_asleep(tree)
                                  ? LeapfrogSync::unknown
                              : is_divided ? LeapfrogSync::same_time
                                           : LeapfrogSync::half_step_before;
    const unsigned char before = std::exchange(lags.of_tree[i], now);
    if (before == now || is_unknown(before) || is_unknown(now)) continue;
    dynamics::kick(system.trees[i], work, (is_divided ? 1 : -1) * time_step / 2);
  }
}

}  // namespace ziggurat::physics
