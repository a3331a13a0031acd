#include "physics/newton/leapfrog_sync.h"

#include <algorithm>
#include <utility>

#include "dynamics/free_motion.h"

namespace ziggurat::physics {

void change_lags(Lags& lags, dynamics::System& system, dynamics::Workspace& work, double length, const Division* division,
                 std::span<const dynamics::ContactPoint> contacts, std::span<const dynamics::Servo> servos) {
  const auto is_unknown = [](unsigned char lag) { return lag == Lags::unknown; };
  if (!division && std::ranges::all_of(lags.of_tree, is_unknown)) return;
  lags.meets.assign(lags.of_tree.size(), 0);
  const auto mark = [&](int tree) {
    if (tree >= 0) lags.meets[static_cast<std::size_t>(tree)] = 1;
  };
  for (const dynamics::ContactPoint& contact : contacts) mark(contact.a.tree), mark(contact.b.tree);
  for (const dynamics::Servo& servo : servos) mark(servo.tree);
  for (std::size_t i = 0; i < lags.of_tree.size(); ++i) {
    const int tree = static_cast<int>(i);
    const bool is_divided = division && division->divides(tree);
    const unsigned char now = lags.meets[i] || system.is_asleep(tree) ? Lags::unknown : is_divided ? Lags::none : Lags::half;
    const unsigned char before = std::exchange(lags.of_tree[i], now);
    if (before == now || is_unknown(before) || is_unknown(now)) continue;
    dynamics::kick(system.trees[i], work, (is_divided ? 1 : -1) * length / 2);
  }
}

}  // namespace ziggurat::physics
