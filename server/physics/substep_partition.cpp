// SPDX-License-Identifier: MIT
#include "physics/substep_partition.h"

#include <algorithm>

namespace ziggurat::physics {

int SubstepPartition::partition(int tree) {
  while (leader_[tree] != tree) tree = leader_[tree] = leader_[leader_[tree]];
  return tree;
}

void SubstepPartition::partition(std::span<const StiffPair> pairs,
                                 std::span<const ColliderPair> near,
                                 std::span<const dynamics::ContactPoint> contacts,
                                 std::span<const dynamics::Servo> servos,
                                 const std::vector<Collider>& colliders,
                                 const std::vector<dynamics::Tree>& trees) {
  const int count = static_cast<int>(trees.size());
  leader_.resize(count);
  for (int i = 0; i < count; ++i) leader_[i] = i;
  parts_.assign(count, 0);
  const auto join = [&](std::size_t a, std::size_t b) {  // the lower one leads
    if (trees[a].dofs == 0 || trees[b].dofs == 0) return;
    const int one = partition(static_cast<int>(a)), other = partition(static_cast<int>(b));
    leader_[std::max(one, other)] = std::min(one, other);
  };
  for (const StiffPair& pair : pairs) join(pair.a, pair.b);
  for (const ColliderPair& each : near) {
    const Collider& a = colliders[each.a];
    const Collider& b = colliders[each.b];
    if (a.moves && b.moves) join(a.entity, b.entity);
  }
  for (const dynamics::ContactPoint& contact : contacts) {
    if (contact.a.tree < 0 || contact.b.tree < 0) continue;
    join(static_cast<std::size_t>(contact.a.tree), static_cast<std::size_t>(contact.b.tree));
  }
  for (const dynamics::Servo& servo : servos) {
    if (servo.other.tree < 0) continue;
    join(static_cast<std::size_t>(servo.tree), static_cast<std::size_t>(servo.other.tree));
  }
  for (const StiffPair& pair : pairs) {
    for (const std::size_t tree : {pair.a, pair.b}) {
      if (trees[tree].dofs == 0) continue;
      int& parts = parts_[partition(static_cast<int>(tree))];
      parts = std::max(parts, pair.parts);
    }
  }
  part_counts_.clear();
  for (int i = 0; i < count; ++i) {
    parts_[i] = parts_[partition(i)];
    if (parts_[i] > 0) part_counts_.push_back(parts_[i]);
  }
  std::sort(part_counts_.begin(), part_counts_.end());
  part_counts_.erase(std::unique(part_counts_.begin(), part_counts_.end()), part_counts_.end());
}

const TreeSet& SubstepPartition::trees_with(int count) {
  active_.trees.clear();
  active_.contains.resize(parts_.size());
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    active_.contains[i] = parts_[i] == count;
    if (parts_[i] == count) active_.trees.push_back(static_cast<int>(i));
  }
  return active_;
}

}  // namespace ziggurat::physics
