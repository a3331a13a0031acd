#include "physics/newton/substep_partition.h"

#include <algorithm>

namespace ziggurat::physics {

int Division::find(int tree) {
  while (leader_[tree] != tree) tree = leader_[tree] = leader_[leader_[tree]];
  return tree;
}

void Division::find(std::span<const StiffPair> pairs, std::span<const Near> near,
                    std::span<const dynamics::ContactPoint> contacts,
                    const std::vector<Collider>& colliders,
                    const std::vector<dynamics::Tree>& trees) {
  const int count = static_cast<int>(trees.size());
  leader_.resize(count);
  for (int i = 0; i < count; ++i) leader_[i] = i;
  parts_.assign(count, 0);
  const auto join = [&](std::size_t a, std::size_t b) {  // the lower one leads
    if (trees[a].dofs == 0 || trees[b].dofs == 0) return;
    const int one = find(static_cast<int>(a)), other = find(static_cast<int>(b));
    leader_[std::max(one, other)] = std::min(one, other);
  };
  for (const StiffPair& pair : pairs) join(pair.a, pair.b);
  for (const Near& each : near) {
    const Collider& a = colliders[each.a];
    const Collider& b = colliders[each.b];
    if (a.moves && b.moves) join(a.entity, b.entity);
  }
  for (const dynamics::ContactPoint& contact : contacts) {
    if (contact.a.tree < 0 || contact.b.tree < 0) continue;
    join(static_cast<std::size_t>(contact.a.tree), static_cast<std::size_t>(contact.b.tree));
  }
  for (const StiffPair& pair : pairs) {
    for (const std::size_t tree : {pair.a, pair.b}) {
      if (trees[tree].dofs == 0) continue;
      int& parts = parts_[find(static_cast<int>(tree))];
      parts = std::max(parts, pair.parts);
    }
  }
  counts_.clear();
  for (int i = 0; i < count; ++i) {
    parts_[i] = parts_[find(i)];
    if (parts_[i] > 0) counts_.push_back(parts_[i]);
  }
  std::sort(counts_.begin(), counts_.end());
  counts_.erase(std::unique(counts_.begin(), counts_.end()), counts_.end());
}

const TreeSet& Division::with(int count) {
  chosen_.trees.clear();
  chosen_.holds.resize(parts_.size());
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    chosen_.holds[i] = parts_[i] == count;
    if (parts_[i] == count) chosen_.trees.push_back(static_cast<int>(i));
  }
  return chosen_;
}

}  // namespace ziggurat::physics
