// SPDX-License-Identifier: MIT
#include "physics/stepping/islands.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "physics/multibody/prefetch.h"

namespace ziggurat::dynamics {
namespace {

/// Order of contacts in an island: it depends on the island alone.
/// @return  < 0: a is earlier; 0: they are alike
int compare(const ContactPoint& a, const ContactPoint& b) {
  const auto order = [](const auto& one, const auto& other) {
    return one < other ? -1 : other < one ? 1 : 0;
  };
  for (const int by : {order(a.a.tree, b.a.tree), order(a.b.tree, b.b.tree),
                       order(a.a.link, b.a.link), order(a.b.link, b.b.link)}) {
    if (by != 0) return by;
  }
  for (int i = 0; i < 3; ++i) {
    if (const int by = order(a.point[i], b.point[i]); by != 0) return by;
  }
  return order(a.gap, b.gap);
}

/// Lists all that islands follow from: trees that are awake, and the trees of each constraint.
/// @param awake  those that move
void list_key(const std::vector<Tree>& trees, const Sleep& sleep, std::span<const int> awake,
              const ConstraintLists& constraints, std::vector<int>& out) {
  constexpr std::size_t counts = 5;
  out.resize(counts + awake.size() + 2 * constraints.contact_trees.size() +
             2 * constraints.servos.size() + constraints.limits.size());
  auto next = out.begin();
  for (const std::size_t number :
       {trees.size(), static_cast<std::size_t>(sleep.changes), awake.size(),
        constraints.contact_trees.size(), constraints.servos.size()})
    *next++ = static_cast<int>(number);
  next = std::ranges::copy(awake, next).out;
  for (const ContactTrees& contact : constraints.contact_trees)
    *next++ = contact.a, *next++ = contact.b;
  for (const Servo& servo : constraints.servos) *next++ = servo.tree, *next++ = servo.other.tree;
  for (const Limit& limit : constraints.limits) *next++ = limit.tree;
}

/// Root of a tree's set in the union-find forest.
int island_root(int tree, std::vector<int>& parent) {
  while (parent[tree] != tree) tree = parent[tree] = parent[parent[tree]];
  return tree;
}

/// Sorts items by island; items of an island keep their order.
/// @param first  out: of each island and one more, in `out`
template <class Item, class IslandOf>
void sort_by_island(std::span<const Item> items, int islands, IslandOf island_of,
                    std::vector<int>& first, std::vector<Item>& out) {
  first.assign(islands + 1, 0);
  for (const Item& item : items) ++first[island_of(item) + 1];
  for (int i = 0; i < islands; ++i) first[i + 1] += first[i];
  out.resize(items.size());
  for (const Item& item : items) out[first[island_of(item)]++] = item;
  for (int i = islands; i > 0; --i) first[i] = first[i - 1];
  first[0] = 0;
}

}  // namespace

void list_contact_trees(std::span<const ContactPoint> contacts, std::vector<ContactTrees>& out) {
  constexpr std::size_t ahead = 8;
  out.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (i + ahead < contacts.size()) prefetch(&contacts[i + ahead], 2 * sizeof(LinkIndex));
    out.push_back({contacts[i].a.tree, contacts[i].b.tree});
  }
}

void build_islands(const std::vector<Tree>& trees, const Sleep& sleep, std::span<const int> awake,
                   const ConstraintLists& constraints, Islands& out) {
  std::swap(out.key, out.key_before);
  list_key(trees, sleep, awake, constraints, out.key);
  if (out.key == out.key_before) return;
  out.parent.resize(trees.size());
  out.of_tree.resize(trees.size());
  out.index_in_island.resize(trees.size());
  for (const int i : awake) out.parent[i] = i;
  const auto moves = [&](int tree) { return tree >= 0 && trees[tree].dofs > 0; };
  const auto acts = [&](int tree) { return moves(tree) && !sleep.is_asleep(tree); };
  const auto join = [&](int a, int b) {  // the lower index leads
    a = island_root(a, out.parent), b = island_root(b, out.parent);
    out.parent[std::max(a, b)] = std::min(a, b);
  };
  out.unsorted.clear();
  for (std::size_t i = 0; i < constraints.contact_trees.size(); ++i) {
    auto [a, b] = constraints.contact_trees[i];
    if (!moves(a)) std::swap(a, b);
    if (!acts(a) || (moves(b) && sleep.is_asleep(b))) continue;
    if (moves(b)) join(a, b);
    out.unsorted.push_back({a, IslandItem::Kind::contact, static_cast<int>(i)});
  }
  for (std::size_t i = 0; i < constraints.servos.size(); ++i) {
    const Servo& servo = constraints.servos[i];
    const int other = servo.other.tree;
    if (!acts(servo.tree) || (other >= 0 && !acts(other))) continue;
    if (other >= 0) join(servo.tree, other);
    out.unsorted.push_back({servo.tree, IslandItem::Kind::servo, static_cast<int>(i)});
  }
  for (std::size_t i = 0; i < constraints.limits.size(); ++i) {
    if (acts(constraints.limits[i].tree))
      out.unsorted.push_back(
          {constraints.limits[i].tree, IslandItem::Kind::limit, static_cast<int>(i)});
  }
  int islands = 0;
  for (const int i : awake) {
    const int leader = island_root(i, out.parent);
    out.of_tree[i] = leader == i ? islands++ : out.of_tree[leader];
  }
  sort_by_island(
      awake, islands, [&](int tree) { return out.of_tree[tree]; }, out.first_tree, out.trees);
  for (std::size_t i = 0; i < out.trees.size(); ++i) {
    out.index_in_island[out.trees[i]] =
        static_cast<int>(i) - out.first_tree[out.of_tree[out.trees[i]]];
  }
  for (IslandItem& item : out.unsorted) item.island = out.of_tree[item.island];
  sort_by_island(
      std::span<const IslandItem>(out.unsorted), islands,
      [](const IslandItem& item) { return item.island; }, out.first_item, out.items);
}

void sort_items(Islands& islands, std::size_t island, std::span<const ContactPoint> contacts) {
  const auto earlier = [&](const IslandItem& a, const IslandItem& b) {
    if (a.kind != b.kind || a.kind != IslandItem::Kind::contact)
      return std::tuple(a.kind, a.index) < std::tuple(b.kind, b.index);
    const int by = compare(contacts[a.index], contacts[b.index]);
    return by < 0 || (by == 0 && a.index < b.index);
  };
  const int first = islands.first_item[island], last = islands.first_item[island + 1];
  const std::span items = std::span(islands.items).subspan(first, last - first);
  if (!std::ranges::is_sorted(items, earlier)) std::ranges::sort(items, earlier);
}

void prefetch_after(const Islands& islands, std::size_t island, const std::vector<Tree>& trees,
                    std::span<const ContactPoint> contacts) {
  constexpr int most = 4;  // trees or items: a large island exceeds the cache anyway
  const auto each = [](const std::vector<int>& first, std::size_t i, auto visit) {
    if (i + 1 >= first.size()) return;
    for (int k = first[i]; k < std::min(first[i + 1], first[i] + most); ++k) visit(k);
  };
  each(islands.first_tree, island + 1, [&](int k) { prefetch(trees[islands.trees[k]]); });
  each(islands.first_tree, island + 2,
       [&](int k) { prefetch(&trees[islands.trees[k]], sizeof(Tree)); });
  each(islands.first_item, island + 1, [&](int k) {
    if (islands.items[k].kind != IslandItem::Kind::contact) return;
    prefetch(&contacts[islands.items[k].index], sizeof(ContactPoint));
  });
}

}  // namespace ziggurat::dynamics
