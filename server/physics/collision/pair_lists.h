// SPDX-License-Identifier: MIT
#pragma once
// Lists of each collider's pairs: removing a collider visits no other pairs.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace ziggurat::physics {

class PairLists {
 public:
  /// Makes lists for this many colliders. Those beyond must be empty.
  void resize(std::size_t colliders) { first_.resize(colliders, 0); }
  void clear() { first_.clear(), links_.clear(); }
  /// Reserves memory for pairs with lower numbers than this: add() takes none then.
  void make_room(std::size_t pairs);
  /// Adds a pair to the lists of its colliders.
  /// @param pair  its number, > 0;  @param b  none: a collider without a list
  void add(int pair, std::size_t a, std::optional<std::size_t> b);
  void remove(int pair);
  /// Appends a collider's pairs to `out`, in any order.
  void collect(std::size_t collider, std::vector<int>& out) const;

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  /// Links of a pair in the lists of its two colliders.
  struct Links {
    std::array<std::size_t, 2> colliders{none, none};
    std::array<int, 2> previous{}, next{};  // 0: none
    std::size_t side(std::size_t collider) const { return colliders[0] == collider ? 0 : 1; }
  };
  std::vector<Links> links_;  // by the pairs' numbers
  std::vector<int> first_;    // of each collider; 0: none
};

struct TreeSet {
  std::vector<int> trees;              ///< ascending
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
