#include "dynamics/system.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "dynamics/equations.h"
#include "dynamics/excess.h"
#include "dynamics/fetch.h"
#include "dynamics/flight.h"
#include "dynamics/impact.h"
#include "dynamics/nutation.h"

namespace ziggurat::dynamics {
namespace {

enum Kind { contact_item, servo_item, limit_item };

bool free_to_drift(const Tree& tree) {
  return tree.links[0].joint == JointType::floating && tree.freedoms == all_freedoms;
}

/// Whether a block does more than push out what is pressed in, or a joint is beyond its limit, as a scene may begin.
/// @param allowed  [m], [rad]
bool holds(const Block& block, double allowed) {
  const double pushed = block.yield > 0 ? 2 * std::max(0.0, block.seek[0]) : 0;
  return std::abs(block.impulse[0]) * block.mobility[0] > pushed ||
         (block.kind == Block::Source::limit && block.gap < -allowed);
}

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Angular momentum about the tree's origin and linear momentum, of a floating tree.
/// @param mass  its matrix
Vector6 momentum(const Tree& tree, const double* mass) {
  Vector6 out = Vector6::Zero();
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < tree.dofs; ++k) out[i] += mass[i * tree.dofs + k] * tree.v[k];
  }
  return out;
}

/// Where the centre of mass of a floating tree is, from its origin [m].
/// @param mass  its matrix
Vector3 centre(const Tree& tree, const double* mass) {
  const int n = tree.dofs;
  return Vector3(mass[2 * n + 4], mass[0 * n + 5], mass[1 * n + 3]) / mass[3 * n + 3];
}

/// Gives a tree that was displaced the momentum that its velocities were before, about its centre of mass: the root's change with
/// its shape. About another point it would be wrong: what struck something did not move along its velocity.
/// @param mass  its matrix before;  @param drift  see momentum_after()
void keep_momentum(Tree& tree, Workspace& work, const double* mass, std::span<const double, 6> drift) {
  Vector6 before = momentum(tree, mass);
  for (int i = 0; i < 6; ++i) before[i] += drift[i];
  compute_mass(tree, work);
  const Vector3 moved = centre(tree, work.mass.data()) - centre(tree, mass);  // from the origin
  before.head<3>() += moved.cross(Vector3(before.tail<3>()));
  const Vector6 missing = before - momentum(tree, work.mass.data());
  Matrix6 root;
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) root(i, k) = work.mass[i * tree.dofs + k];
  }
  const Vector6 change = root.llt().solve(missing);
  for (int i = 0; i < 6; ++i) tree.v[i] += change[i];
  move(tree);
}

void add(const Outcome& outcome, Report& report) {
  ++report.islands;
  report.not_converged += !outcome.converged;
  report.most_iterations = std::max(report.most_iterations, outcome.iterations);
  report.most_descents = std::max(report.most_descents, outcome.descents);
  report.most_interior = std::max(report.most_interior, outcome.interior);
  report.most_sweeps = std::max(report.most_sweeps, outcome.sweeps);
  report.miss = std::max(report.miss, outcome.miss);
}

/// Notes places and speeds of an island's trees.
void keep(const std::vector<Tree>& trees, std::span<const int> island, std::vector<double>& out) {
  out.clear();
  for (const int number : island) {
    out.insert(out.end(), trees[number].q.begin(), trees[number].q.end());
    out.insert(out.end(), trees[number].v.begin(), trees[number].v.end());
  }
}

/// Gives them back.
void put_back(std::vector<Tree>& trees, std::span<const int> island, const std::vector<double>& kept) {
  const double* next = kept.data();
  for (const int number : island) {
    Tree& tree = trees[number];
    std::copy_n(next, tree.q.size(), tree.q.begin());
    std::copy_n(next + tree.q.size(), tree.v.size(), tree.v.begin());
    next += tree.q.size() + tree.v.size();
    place(tree);
    move(tree);
  }
}

/// Notes which trees of an island nothing but motors of joints acts on: what they come near does not hold them.
/// @param allowed  see holds()
/// @return         how many
std::size_t find_free(const Problem& problem, std::span<const Servo> servos, double allowed, std::vector<unsigned char>& out) {
  std::size_t count = problem.trees.size();
  out.assign(count, 1);
  const auto touch = [&](int tree) { count -= tree >= 0 && std::exchange(out[tree], 0); };
  for (const Block& block : problem.blocks) {
    const bool is_motor = block.kind == Block::Source::servo && servos[block.source].dof >= 0;
    if (is_motor || !holds(block, allowed)) continue;
    touch(block.a);
    touch(block.b);
    if (count == 0) break;
  }
  return count;
}

/// Moves a tree of the island. What nothing fixed rubs keeps its momentum, and so does what would gain energy.
void displace(const Problem& problem, std::size_t i, std::span<const double> by, bool drifts,
              const Excesses& excesses, Workspace& work) {
  Tree& tree = *problem.trees[i];
  displace(tree, by);
  place(tree);
  move(tree);
  const Excess& excess = excesses.of_trees[i];
  const bool gains = excess.kind != Excess::Kind::none && !excess.of_free_joints &&
                     gains_much(tree, excess.before + kinetic_energy(tree));
  if (free_to_drift(tree) && (drifts || gains)) {
    keep_momentum(tree, work, problem.mass_of(i), problem.drift[i]);
  }
  if (excess.kind == Excess::Kind::none) return;
  undo_excess(tree, work, excess, std::span(excesses.held).subspan(problem.offset[i], tree.dofs),
              !drifts);
}

/// Gives back to contacts, servos and limits what they gave, in world axes.
void write_impulses(const Problem& problem, std::span<Contact> contacts, std::span<Servo> servos, std::span<Limit> limits) {
  for (const Block& block : problem.blocks) {
    const auto& g = block.impulse;
    switch (block.kind) {
      case Block::Source::contact: {
        Contact& contact = contacts[block.source];
        contact.impulse = block.frame * Vector3(g[0], g[1], g[2]);
        contact.angular_impulse = block.frame * Vector3(g[3], g[4], g[5]);
        break;
      }
      case Block::Source::servo:
        servos[block.source].impulse = g[0];
        break;
      case Block::Source::limit:  // along the joint at the lower bound, against it at the upper
        limits[block.source].impulse = problem.jacobian[block.ja + block.dofs_a[0]] * g[0];
        break;
    }
  }
}

/// The order of contacts in an island: it depends on the island alone.
bool is_earlier(const Contact& a, const Contact& b) {
  const auto key = [](const Contact& c) {
    return std::tuple(c.a.tree, c.b.tree, c.a.link, c.b.link, c.point.x(), c.point.y(), c.point.z(), c.gap);
  };
  return key(a) < key(b);
}

/// Takes the velocities of a solution, and how far they move trees; those that are free have moved.
void take_velocities(const Problem& problem, const std::vector<unsigned char>& free, std::vector<double>& step) {
  step.resize(problem.velocity.size());
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    Tree& tree = *problem.trees[i];
    for (int k = 0; k < tree.dofs; ++k) {
      const double speed = problem.velocity[problem.offset[i] + k];
      step[problem.offset[i] + k] = free[i] ? 0 : problem.length * speed;
      if (!free[i]) tree.v[k] = speed;
    }
  }
}

/// Whether the world rubs the island.
bool world_rubs(const Problem& problem) {
  return std::ranges::any_of(problem.blocks, [](const Block& b) {
    return b.kind == Block::Source::contact && (b.a < 0 || b.b < 0) && b.friction > 0;
  });
}

/// Whether the world carries it.
bool world_carries(const Problem& problem) {
  return std::ranges::any_of(problem.blocks, [](const Block& b) {
    return b.kind == Block::Source::contact && (b.a < 0 || b.b < 0) && b.impulse[0] > 0;
  });
}

/// Whether a motor moves something, however slowly.
bool motors_move(const Problem& problem) {
  constexpr double rounding = 1e-7;  // of what a motor holds [m/s], [rad/s]
  return std::ranges::any_of(problem.blocks, [](const Block& b) {
    const bool obeys = b.lower < b.impulse[0] && b.impulse[0] < b.upper;
    return b.kind == Block::Source::servo && obeys && std::abs(b.seek[0]) > rounding;
  });
}

}  // namespace

void LeftIslands::add(std::span<const int> of_island, int parts) {
  islands.push_back({parts, trees.size(), trees.size() + of_island.size()});
  trees.insert(trees.end(), of_island.begin(), of_island.end());
}

int System::find(int tree) {
  while (parent_[tree] != tree) tree = parent_[tree] = parent_[parent_[tree]];
  return tree;
}

/// Sorts trees that are awake and what acts on them by island; islands by their first tree.
void System::gather(std::span<const Contact> contacts, std::span<const Servo> servos,
                    std::span<const Limit> limits) {
  parent_.resize(trees.size());
  island_.resize(trees.size());
  place_.resize(trees.size());
  for (const int i : awake_) parent_[i] = i;
  const auto moves = [&](int tree) { return tree >= 0 && trees[tree].dofs > 0; };
  const auto acts = [&](int tree) { return moves(tree) && !asleep(tree); };
  items_.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    int a = contacts[i].a.tree, b = contacts[i].b.tree;
    if (!moves(a)) std::swap(a, b);
    if (!acts(a) || (moves(b) && asleep(b))) continue;
    if (moves(b)) {  // the lower index leads
      a = find(a), b = find(b);
      parent_[std::max(a, b)] = std::min(a, b);
    }
    items_.push_back({a, contact_item, static_cast<int>(i)});
  }
  for (std::size_t i = 0; i < servos.size(); ++i) {
    if (acts(servos[i].tree)) items_.push_back({servos[i].tree, servo_item, static_cast<int>(i)});
  }
  for (std::size_t i = 0; i < limits.size(); ++i) {
    if (acts(limits[i].tree)) items_.push_back({limits[i].tree, limit_item, static_cast<int>(i)});
  }
  int islands = 0;
  for (const int i : awake_) {
    const int leader = find(i);
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
    return is_earlier(contacts[a.index], contacts[b.index]);
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
  limits_ = limits;
  chosen_ = chosen;
  report_ = {};
  left.islands.clear();
  left.trees.clear();
  wake_disturbed(length, contacts, servos);
  find_awake();
  report_.awake = static_cast<int>(awake_.size());
  gather(contacts, servos, limits);
  for (std::size_t i = 0; i + 1 < first_tree_.size(); ++i) {
    const int first = first_tree_[i], last = first_tree_[i + 1];
    fetch_after(i);
    if (fly_island(first, last, first_item_[i], first_item_[i + 1])) {
      settle(first, last, false);
    } else {
      solve_island(first, last, first_item_[i], first_item_[i + 1]);
    }
  }
  forget_pushes();
  chosen_ = {};
  return report_;
}

/// Whether a joint of the island, or of a tree of it, is beyond a limit.
/// @param of  the tree; -1: all
bool System::is_beyond(int first_item, int last_item, int of) const {
  return std::any_of(item_order_.begin() + first_item, item_order_.begin() + last_item, [&](const Item& item) {
    if (item.kind != limit_item) return false;
    const Limit& limit = limits_[item.index];
    if (of >= 0 && limit.tree != of) return false;
    const Tree& tree = trees[limit.tree];
    const double q = tree.q[tree.first_place[limit.link]];
    return q < limit.lower || q > limit.upper;
  });
}

/// Advances an island where nothing holds it, as far as can be seen.
/// @return  whether it flew, and hit nothing
bool System::fly_island(int first_tree, int last_tree, int first_item, int last_item) {
  for (int i = first_item; i < last_item; ++i) {
    if (item_order_[i].kind != limit_item) return false;
  }
  if (is_beyond(first_item, last_item)) return false;
  const auto island = std::span(tree_order_).subspan(first_tree, last_tree - first_tree);
  if (first_item < last_item) keep(trees, island, kept_);
  for (const int tree : island) fly(trees[tree], work_, length_);
  if (is_beyond(first_item, last_item)) {
    put_back(trees, island, kept_);
    return false;
  }
  for (int i = first_item; i < last_item; ++i) limits_[item_order_[i].index].impulse = 0;
  return true;
}

/// The problem of the trees and items of one island.
void System::gather_island(int first_tree, int last_tree, int first_item, int last_item) {
  problem_.clear();
  problem_.length = length_;
  problem_.allowed_overlap = allowed_overlap;
  problem_.softness = softness;
  problem_.several = last_tree - first_tree > 1;
  driven_.assign(last_tree - first_tree, 0);
  for (int i = first_item; i < last_item; ++i) {
    const auto& [island, kind, index] = item_order_[i];
    if (kind == servo_item && is_obeyed(servos_[index])) driven_[place_[servos_[index].tree]] = 1;
  }
  for (int i = first_tree; i < last_tree; ++i) {
    problem_.add(trees[tree_order_[i]], work_, driven_[i - first_tree]);
  }
  const auto place = [&](int tree) {
    return tree >= 0 && trees[tree].dofs > 0 ? place_[tree] : -1;
  };
  for (int i = first_item; i < last_item; ++i) {
    const auto [island, kind, index] = item_order_[i];
    if (kind == contact_item) {
      problem_.add(contacts_[index], place(contacts_[index].a.tree), place(contacts_[index].b.tree),
                   index);
    } else if (kind == servo_item) {
      problem_.add(servos_[index], place(servos_[index].tree), index);
    } else {
      problem_.add(limits_[index], place(limits_[index].tree), index);
    }
  }
}

/// Flies those trees of an island that are free, as far as they stay within the limits of their joints; others are free no more.
/// @return  whether all did
bool System::fly_free(int first_tree, int last_tree, int first_item, int last_item) {
  find_drives(problem_, servos_, drives_);
  bool all = true;
  for (int i = 0; i < last_tree - first_tree; ++i) {
    const std::span<const int> tree(&tree_order_[first_tree + i], 1);
    if (free_[i]) {
      keep(trees, tree, kept_);
      fly(trees[tree[0]], work_, length_, drive_of(problem_, i, drives_));
      free_[i] = !is_beyond(first_item, last_item, tree[0]);
      if (!free_[i]) put_back(trees, tree, kept_);
    }
    all &= free_[i];
  }
  return all;
}

void System::solve_island(int first_tree, int last_tree, int first_item, int last_item) {
  const auto island = std::span(tree_order_).subspan(first_tree, last_tree - first_tree);
  gather_island(first_tree, last_tree, first_item, last_item);
  aim_rebounds(problem_);
  problem_.bound_depth();
  const Outcome outcome = solver_.solve(problem_);
  std::size_t free = find_free(problem_, servos_, allowed_overlap, free_);
  const bool touched = free < free_.size();
  if (most_parts > 1) {
    const int parts = std::max(touched ? parts_for_tension(problem_, contacts_, work_, tension_) : 1, parts_for_nutation(problem_, work_));
    if (parts > 1) {
      for (const int tree : island) watch_[tree] |= Watch::waits;
      report_.not_converged += parts > most_parts;
      return left.add(island, std::min(parts, most_parts));
    }
  }
  add(outcome, report_);
  const bool rebounding = rebounds(problem_);
  if (rebounding) bound_impacts(problem_, solver_, work_, rebound_);
  write_impulses(problem_, contacts_, servos_, limits_);
  if (rebounding) free_.assign(free_.size(), free = 0);  // its energy is bounded as a whole
  if (free > 0 && fly_free(first_tree, last_tree, first_item, last_item)) return settle(first_tree, last_tree, false);
  const double before = energy_if_passive(problem_);
  note_excesses(problem_, work_, excesses_);
  take_velocities(problem_, free_, step_);
  const bool grounded = world_rubs(problem_), rests = world_carries(problem_) && !motors_move(problem_);
  if (problem_.turn_into_displacement()) {
    solver_.solve_displacement(problem_);
    if (rebounding && lifts_too_much(problem_, work_, rebound_, step_)) {
      problem_.leave_rebounds();
      solver_.solve_displacement(problem_);
    } else if (rebounding) {
      bound_way(problem_, rebound_);
    }
    for (std::size_t i = 0; i < step_.size(); ++i) step_[i] += problem_.velocity[i];
    add_lifts(problem_, work_, excesses_);
  }
  for (std::size_t i = 0; i < problem_.trees.size(); ++i) {
    const std::span<const double> by(step_.data() + problem_.offset[i], problem_.trees[i]->dofs);
    if (!free_[i]) {
      displace(problem_, i, by, !grounded, excesses_, work_);
    } else if (std::ranges::any_of(by, [](double way) { return way != 0; })) {  // something is pushed out of it
      displace(*problem_.trees[i], by);
      place(*problem_.trees[i]);
      move(*problem_.trees[i]);
    }
  }
  if (rebounding) bound_energy(problem_, work_, rebound_);
  bound_gain(problem_, work_, before, grounded, is_part);
  const bool swept = outcome.sweeps > 0 && outcome.descents == 0;
  settle(first_tree, last_tree, rests, swept ? outcome.miss : 0);
}

void System::push_apart(std::span<Contact> contacts, std::span<const int> chosen) {
  contacts_ = contacts;
  servos_ = {};
  chosen_ = chosen;
  find_awake();
  gather(contacts_, servos_, limits_);
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
