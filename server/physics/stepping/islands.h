// SPDX-License-Identifier: MIT
#pragma once
// Islands: sets of awake trees that contacts connect, each with its constraints. An island is
// solved alone.

#include <span>
#include <vector>

#include "physics/stepping/sleeping.h"

namespace ziggurat::dynamics {

/// A constraint of an island.
struct IslandItem {
  enum class Kind : unsigned char { contact, servo, limit };
  int island = 0;
  Kind kind = Kind::contact;
  int index = 0;  ///< in the list of its kind
};

/// An island: its trees, ascending, and its constraints, contacts first: see sort_items().
struct Island {
  std::span<const int> trees;
  std::span<const IslandItem> items;
  /// Whether it has a contact.
  bool has_contact() const {
    return !items.empty() && items.front().kind == IslandItem::Kind::contact;
  }
};

/// All islands, in the order of their first trees.
struct Islands {
  std::vector<int> of_tree;          ///< of each awake tree: its island
  std::vector<int> index_in_island;  ///< of each awake tree: its place in the island
  std::vector<int> trees,
      first_tree;  ///< of island i: trees[first_tree[i]] up to first_tree[i + 1]
  std::vector<IslandItem> items;
  std::vector<int> first_item;

  std::size_t size() const { return first_tree.size() - 1; }
  Island operator[](std::size_t i) const {
    return {std::span(trees).subspan(first_tree[i], first_tree[i + 1] - first_tree[i]),
            std::span(items).subspan(first_item[i], first_item[i + 1] - first_item[i])};
  }

  /// All that they follow from, in this step and in the one before.
  std::vector<int> key, key_before;

  // Memory of build_islands().
  std::vector<int> parent;  ///< of each awake tree, in the union-find forest
  std::vector<IslandItem> unsorted;
};

/// Sorts awake trees and their constraints by island. Contacts of sleepers are left out. Islands of
/// the same trees and constraints as in the last call stay as they are.
/// @param awake  ascending
void build_islands(const std::vector<Tree>& trees, const Sleep& sleep, std::span<const int> awake,
                   const ConstraintLists& constraints, Islands& out);

/// Puts the constraints of an island into an order that depends on it alone: contacts, by trees,
/// links and places, then servos and limits. It changes nothing of other islands.
void sort_items(Islands& islands, std::size_t island, std::span<const ContactPoint> contacts);

/// Prefetches the memory of the islands after one: the trees of the second, and all data of the
/// first.
void prefetch_after(const Islands& islands, std::size_t island, const std::vector<Tree>& trees,
                    std::span<const ContactPoint> contacts);

}  // namespace ziggurat::dynamics
