#include "dynamics/system.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "dynamics/energy_error.h"
#include "dynamics/prefetch.h"

namespace ziggurat::dynamics {
namespace {

/// The order of contacts in an island: it depends on the island alone.
bool is_earlier(const Contact& a, const Contact& b) {
  const auto key = [](const Contact& c) {
    return std::tuple(c.a.tree, c.b.tree, c.a.link, c.b.link, c.point.x(), c.point.y(), c.point.z(), c.gap);
  };
  return key(a) < key(b);
}

/// The tree that leads those which one is joined with.
int leader_of(int tree, std::vector<int>& parent) {
  while (parent[tree] != tree) tree = parent[tree] = parent[parent[tree]];
  return tree;
}

}  // namespace

void note_ends(std::span<const Contact> contacts, std::vector<Ends>& out) {
  constexpr std::size_t ahead = 8;
  out.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (i + ahead < contacts.size()) fetch(&contacts[i + ahead], 2 * sizeof(LinkIndex));
    out.push_back({contacts[i].a.tree, contacts[i].b.tree});
  }
}

void LeftIslands::add(std::span<const int> of_island, int parts) {
  islands.push_back({parts, trees.size(), trees.size() + of_island.size()});
  trees.insert(trees.end(), of_island.begin(), of_island.end());
}

/// Sorts trees that are awake and what acts on them by island; islands by their first tree.
void System::gather() {
  parent_.resize(trees.size());
  island_.resize(trees.size());
  place_.resize(trees.size());
  for (const int i : awake_) parent_[i] = i;
  const auto moves = [&](int tree) { return tree >= 0 && trees[tree].dofs > 0; };
  const auto acts = [&](int tree) { return moves(tree) && !asleep(tree); };
  items_.clear();
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    auto [a, b] = ends_[i];
    if (!moves(a)) std::swap(a, b);
    if (!acts(a) || (moves(b) && asleep(b))) continue;
    if (moves(b)) {  // the lower index leads
      a = leader_of(a, parent_), b = leader_of(b, parent_);
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
    const int leader = leader_of(i, parent_);
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
    place_[tree_order_[i]] = static_cast<int>(i) - first_tree_[island_[tree_order_[i]]];
  }
  first_item_.assign(islands + 1, 0);
  for (Item& item : items_) {
    item.island = island_[item.island];
    ++first_item_[item.island + 1];
  }
  for (int i = 0; i < islands; ++i) first_item_[i + 1] += first_item_[i];
  item_order_.resize(items_.size());
  for (const Item& item : items_) item_order_[first_item_[item.island]++] = item;
  for (int i = islands; i > 0; --i) first_item_[i] = first_item_[i - 1];
  first_item_[0] = 0;
  const auto earlier = [&](const Item& a, const Item& b) {
    if (a.kind != b.kind || a.kind != contact_item) return std::tuple(a.kind, a.index) < std::tuple(b.kind, b.index);
    return is_earlier(contacts_[a.index], contacts_[b.index]);
  };
  for (int i = 0; i < islands; ++i) {
    const auto of_island = std::span(item_order_).subspan(first_item_[i], first_item_[i + 1] - first_item_[i]);
    if (!std::ranges::is_sorted(of_island, earlier)) std::ranges::sort(of_island, earlier);
  }
}

/// Those that take part.
void System::find_awake() {
  awake_.clear();
  each_that_takes_part([&](int tree) {
    if (trees[tree].dofs > 0 && !asleep(tree)) awake_.push_back(tree);
  });
}

/// Asks for the memory of the islands after one: for the trees of the second, and, when they are there,
/// for all that the first is made of.
void System::fetch_after(std::size_t island) const {
  constexpr int most = 4;  // trees or items: a large island does not fit anyway
  const auto each = [](const std::vector<int>& first, std::size_t i, auto visit) {
    if (i + 1 >= first.size()) return;
    for (int k = first[i]; k < std::min(first[i + 1], first[i] + most); ++k) visit(k);
  };
  each(first_tree_, island + 1, [&](int k) { fetch(trees[tree_order_[k]]); });
  each(first_tree_, island + 2, [&](int k) { fetch(&trees[tree_order_[k]], sizeof(Tree)); });
  each(first_item_, island + 1, [&](int k) {
    if (item_order_[k].kind != contact_item) return;
    fetch(&contacts_[item_order_[k].index], sizeof(Contact));
  });
}

Report System::step(double length, std::span<Contact> contacts, std::span<Servo> servos,
                    std::span<Limit> limits, std::span<const int> chosen) {
  wake_disturbed(length, contacts, servos, chosen);
  return advance(limits);
}

Report System::advance(std::span<Limit> limits) {
  limits_ = limits;
  report_ = {};
  left.islands.clear();
  left.trees.clear();
  find_awake();
  report_.awake = static_cast<int>(awake_.size());
  gather();
  for (std::size_t i = 0; i + 1 < first_tree_.size(); ++i) {
    const int first = first_tree_[i], last = first_tree_[i + 1];
    fetch_after(i);
    if (fly_island(first, last, first_item_[i], first_item_[i + 1])) {
      settle(first, last, false);
    } else {
      solve_island(first, last, first_item_[i], first_item_[i + 1]);
    }
    if (!std::exchange(work_.late, false)) continue;
    ++report_.not_converged;
    report_.islands = std::max(report_.islands, report_.not_converged);
  }
  forget_pushes();
  chosen_ = {};
  return report_;
}

void System::push_apart(std::span<Contact> contacts, std::span<const int> chosen) {
  contacts_ = contacts;
  note_ends(contacts_, ends_);
  servos_ = {};
  chosen_ = chosen;
  find_awake();
  gather();
  for (std::size_t i = 0; i + 1 < first_tree_.size(); ++i) {
    const int first = first_item_[i], last = first_item_[i + 1];
    if (first == last || item_order_[first].kind != contact_item) continue;
    gather_island(first_tree_[i], first_tree_[i + 1], first, last);
    std::fill(problem_.velocity.begin(), problem_.velocity.end(), 0.0);
    for (Block& block : problem_.blocks) block.impulse.fill(0);
    if (!problem_.turn_into_displacement()) continue;
    const double before = energy(problem_.trees);
    solver_.solve_displacement(problem_);
    for (std::size_t k = 0; k < problem_.trees.size(); ++k) {
      Tree& tree = *problem_.trees[k];
      displace(tree, {problem_.velocity.data() + problem_.offset[k],
                      static_cast<std::size_t>(tree.dofs)});
      dynamics::place(tree);
      move(tree);
    }
    take_excess(problem_.trees, work_, energy(problem_.trees) - before);
  }
  chosen_ = {};
}

}  // namespace ziggurat::dynamics
