// SPDX-License-Identifier: MIT
#include "physics/collision/pair_lists.h"

namespace ziggurat::physics {

void PairLists::make_room(std::size_t pairs) {
  if (links_.size() < pairs) links_.resize(pairs);
}

void PairLists::add(int pair, std::size_t a, std::optional<std::size_t> b) {
  Links& place = links_[pair];
  place.colliders = {a, b.value_or(none)};
  for (std::size_t side = 0; side < 2; ++side) {
    const std::size_t collider = place.colliders[side];
    if (collider == none) continue;
    const int next = first_[collider];
    place.previous[side] = 0;
    place.next[side] = next;
    if (next != 0) links_[next].previous[links_[next].side(collider)] = pair;
    first_[collider] = pair;
  }
}

void PairLists::remove(int pair) {
  const Links& place = links_[pair];
  for (std::size_t side = 0; side < 2; ++side) {
    const std::size_t collider = place.colliders[side];
    if (collider == none) continue;
    const int previous = place.previous[side], next = place.next[side];
    if (previous == 0) {
      first_[collider] = next;
    } else {
      links_[previous].next[links_[previous].side(collider)] = next;
    }
    if (next != 0) links_[next].previous[links_[next].side(collider)] = previous;
  }
}

void PairLists::collect(std::size_t collider, std::vector<int>& out) const {
  if (collider >= first_.size()) return;
  for (int pair = first_[collider]; pair != 0;) {
    out.push_back(pair);
    pair = links_[pair].next[links_[pair].side(collider)];
  }
}

}  // namespace ziggurat::physics
