#include "dynamics/system.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "dynamics/energy_error.h"
#include "dynamics/prefetch.h"

namespace ziggurat::dynamics {
namespace {

/// Order of contacts in an island: it depends on the island alone.
bool is_earlier(const ContactPoint& a, const ContactPoint& b) {
  const auto key = [](const ContactPoint& c) {
    return std::tuple(c.a.tree, c.b.tree, c.a.link, c.b.link, c.point.x(), c.point.y(), c.point.z(), c.gap);
  };
  return key(a) < key(b);
}

/// Root of a tree's set in the union-find forest.
int island_root(int tree, std::vector<int>& parent) {
  while (parent[tree] != tree) tree = parent[tree] = parent[parent[tree]];
  return tree;
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

void IslandsToSubdivide::add(std::span<const int> of_island, int parts, double impact_time) {
  islands.push_back({parts, impact_time, trees.size(), trees.size() + of_island.size()});
  trees.insert(trees.end(), of_island.begin(), of_island.end());
}

/// Sorts awake trees and their constraints by island; islands by their first tree.
void System::build_islands() {
  parent_.resize(trees.size());
  island_.resize(trees.size());
  index_in_island_.resize(trees.size());
  for (const int i : awake_) parent_[i] = i;
  const auto moves = [&](int tree) { return tree >= 0 && trees[tree].dofs > 0; };
  const auto acts = [&](int tree) { return moves(tree) && !is_asleep(tree); };
  items_.clear();
  for (std::size_t i = 0; i < contact_trees_.size(); ++i) {
    auto [a, b] = contact_trees_[i];
    if (!moves(a)) std::swap(a, b);
    if (!acts(a) || (moves(b) && is_asleep(b))) continue;
    if (moves(b)) {  // the lower index leads
      a = island_root(a, parent_), b = island_root(b, parent_);
      parent_[std::max(a, b)] = std::min(a, b);
    }
    items_.push_back({a, contact_item, static_cast<int>(i)});
  }
  for (std::size_t i = 0; i < servos_.size(); ++i) {
    if (acts(servos_[i].tree)) items_.push_back({servos_[i].tree, servo_item, static_cast<int>(i)});
  }
  for (std::size_t i = 0; i < limits_.size(); ++i) {
    if (acts(limits_[i].tree)) items_.push_back({limits_[i].tree, limit_item, static_cast<int>(i)});
  }
  int islands = 0;
  for (const int i : awake_) {
    const int leader = island_root(i, parent_);
    island_[i] = leader == i ? islands++ : island_[leader];
  }
  first_tree_.assign(islands + 1, 0);
  for (const int i : awake_) ++first_tree_[island_[i] + 1];
  for (int i = 0; i < islands; ++i) first_tree_[i + 1] += first_tree_[i];
  tree_order_.resize(awake_.size());
  for (const int i : awake_) tree_order_[first_tree_[island_[i]]++] = i;
  for (int i = islands; i > 0; --i) first_tree_[i] = first_tree_[i - 1];
  first_tree_[0] = 0;
  for (std::size_t i = 0; i < tree_order_.size(); ++i) {
    index_in_island_[tree_order_[i]] = static_cast<int>(i) - first_tree_[island_[tree_order_[i]]];
  }
  first_item_.assign(islands + 1, 0);
  for (IslandItem& item : items_) {
    item.island = island_[item.island];
    ++first_item_[item.island + 1];
  }
  for (int i = 0; i < islands; ++i) first_item_[i + 1] += first_item_[i];
  item_order_.resize(items_.size());
  for (const IslandItem& item : items_) item_order_[first_item_[item.island]++] = item;
  for (int i = islands; i > 0; --i) first_item_[i] = first_item_[i - 1];
  first_item_[0] = 0;
  const auto earlier = [&](const IslandItem& a, const IslandItem& b) {
    if (a.kind != b.kind || a.kind != contact_item) return std::tuple(a.kind, a.index) < std::tuple(b.kind, b.index);
    return is_earlier(contacts_[a.index], contacts_[b.index]);
  };
  for (int i = 0; i < islands; ++i) {
    const auto of_island = std::span(item_order_).subspan(first_item_[i], first_item_[i + 1] - first_item_[i]);
    if (!std::ranges::is_sorted(of_island, earlier)) std::ranges::sort(of_island, earlier);
  }
}

/// Lists the active trees that are awake.
void System::list_awake() {
  awake_.clear();
  for_each_active([&](int tree) {
    if (trees[tree].dofs > 0 && !is_asleep(tree)) awake_.push_back(tree);
  });
}

/// Prefetches the memory of the islands after one: the trees of the second, and all data of the
/// first.
void System::prefetch_after(std::size_t island) const {
  constexpr int most = 4;  // trees or items: a large island exceeds the cache anyway
  const auto each = [](const std::vector<int>& first, std::size_t i, auto visit) {
    if (i + 1 >= first.size()) return;
    for (int k = first[i]; k < std::min(first[i + 1], first[i] + most); ++k) visit(k);
  };
  each(first_tree_, island + 1, [&](int k) { prefetch(trees[tree_order_[k]]); });
  each(first_tree_, island + 2, [&](int k) { prefetch(&trees[tree_order_[k]], sizeof(Tree)); });
  each(first_item_, island + 1, [&](int k) {
    if (item_order_[k].kind != contact_item) return;
    prefetch(&contacts_[item_order_[k].index], sizeof(ContactPoint));
  });
}

Report System::step(double time_step, std::span<ContactPoint> contacts, std::span<Servo> servos,
                    std::span<Limit> limits, std::span<const int> chosen) {
  wake_disturbed(time_step, contacts, servos, chosen);
  return advance(limits);
}

Report System::advance(std::span<Limit> limits) {
  limits_ = limits;
  report_ = {};
  islands_to_subdivide.islands.clear();
  islands_to_subdivide.trees.clear();
  list_awake();
  report_.awake = static_cast<int>(awake_.size());
  build_islands();
  for (std::size_t i = 0; i + 1 < first_tree_.size(); ++i) {
    const int first = first_tree_[i], last = first_tree_[i + 1];
    prefetch_after(i);
    if (integrate_free_island(first, last, first_item_[i], first_item_[i + 1])) {
      update_sleep(first, last, false);
    } else {
      solve_island(first, last, first_item_[i], first_item_[i + 1]);
    }
    if (!std::exchange(work_.ran_out_of_steps, false)) continue;
    ++report_.not_converged;
    report_.islands = std::max(report_.islands, report_.not_converged);
  }
  clear_wrenches();
  active_ = {};
  return report_;
}

void System::separate(std::span<ContactPoint> contacts, std::span<const int> chosen) {
  contacts_ = contacts;
  list_contact_trees(contacts_, contact_trees_);
  servos_ = {};
  active_ = chosen;
  list_awake();
  build_islands();
  for (std::size_t i = 0; i + 1 < first_tree_.size(); ++i) {
    const int first = first_item_[i], last = first_item_[i + 1];
    if (first == last || item_order_[first].kind != contact_item) continue;
    assemble_problem(first_tree_[i], first_tree_[i + 1], first, last);
    std::fill(problem_.velocity.begin(), problem_.velocity.end(), 0.0);
    for (Constraint& constraint : problem_.constraints) constraint.impulse.fill(0);
    if (!problem_.become_displacement()) continue;
    const double before = energy(problem_.trees);
    solver_.solve_displacement(problem_);
    for (std::size_t k = 0; k < problem_.trees.size(); ++k) {
      Tree& tree = *problem_.trees[k];
      integrate_positions(tree, {problem_.velocity.data() + problem_.offset[k],
                      static_cast<std::size_t>(tree.dofs)});
      dynamics::forward_kinematics(tree);
      velocity_kinematics(tree);
    }
    remove_kinetic_energy(problem_.trees, work_, energy(problem_.trees) - before);
  }
  active_ = {};
}

}  // namespace ziggurat::dynamics
