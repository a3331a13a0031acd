#pragma once
// A set of trees that take a substep, or a part of one, together.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ziggurat::physics {

struct TreeSet {
  std::vector<int> trees;           ///< ascending
  std::vector<std::uint8_t> contains;  ///< of each tree of the system whether it is in the set
};

/// Calls visit(item) for the items of a set's trees, in ascending order.
/// @param items  ascending by `entity`, the number of the tree they belong to
template <class Item, class Visit>
void each_of(std::vector<Item>& items, const TreeSet& set, Visit visit) {
  const auto is_before = [](const Item& item, std::size_t entity) { return item.entity < entity; };
  for (const int tree : set.trees) {
    const auto entity = static_cast<std::size_t>(tree);
    auto item = std::lower_bound(items.begin(), items.end(), entity, is_before);
    for (; item != items.end() && item->entity == entity; ++item) visit(*item);
  }
}

}  // namespace ziggurat::physics
