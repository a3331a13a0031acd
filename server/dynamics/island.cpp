// One island in a substep: it flies, or its problem is solved and it moves by the solution.

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "dynamics/equations.h"
#include "dynamics/energy_error.h"
#include "dynamics/free_motion.h"
#include "dynamics/restitution_timing.h"
#include "dynamics/gyroscopic_stiffness.h"
#include "dynamics/system.h"

namespace ziggurat::dynamics {
namespace {

/// Instead of the contact that pushes a tree.
constexpr int no_contact = -1, several_contacts = -2;

bool free_to_drift(const Tree& tree) {
  return tree.links[0].joint == JointType::floating && tree.freedoms == all_freedoms;
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

/// Moves a tree that flew out of what it overlaps. A single body is not turned, so that its momenta and its energy stay.
void push_out(Tree& tree, std::span<const double> by) {
  if (tree.single && free_to_drift(tree)) {
    displace(tree, std::array{0.0, 0.0, 0.0, by[3], by[4], by[5]});
  } else {
    displace(tree, by);
  }
  place(tree);
  move(tree);
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

/// Notes of each tree the contact that pushes it, or that several do: those of another body, or along another normal.
void find_only_contacts(const Problem& problem, std::vector<int>& out) {
  constexpr double parallel = 1 - 1e-6;  // cosine of the angle between normals
  out.assign(problem.trees.size(), no_contact);
  for (std::size_t i = 0; i < problem.blocks.size(); ++i) {
    const Block& block = problem.blocks[i];
    if (block.kind != Block::Source::contact || block.impulse[0] == 0) continue;
    for (const int tree : {block.a, block.b}) {
      if (tree < 0 || out[tree] == several_contacts) continue;
      const Block& first = problem.blocks[out[tree] == no_contact ? i : static_cast<std::size_t>(out[tree])];
      const bool same = first.a == block.a && first.b == block.b && first.frame.col(0).dot(block.frame.col(0)) > parallel;
      out[tree] = !same ? several_contacts : out[tree] == no_contact ? static_cast<int>(i) : out[tree];
    }
  }
}

/// Friction between two that meet within the substep acts when they do. So what turns them, about the points that meet, and what moves
/// them are one impulse, and angular momentum stays. What is nipped between others moves as it is solved: friction of one contact
/// balances impulses of another one, and is no part of its motion by itself.
/// @param only  memory
void wait_for_friction(const Problem& problem, std::span<const Contact> contacts, std::vector<int>& only, std::vector<double>& step) {
  const auto waits = [&](const Block& block) {
    if (block.kind != Block::Source::contact || block.rows < 3 || block.impulse[0] == 0 || block.a < 0 || block.b < 0) return false;
    return -contacts[block.source].until_met.dot(contacts[block.source].normal) >= touching;
  };
  if (std::ranges::none_of(problem.blocks, waits)) return;
  find_only_contacts(problem, only);
  for (const Block& block : problem.blocks) {
    if (!waits(block) || only[block.a] == several_contacts || only[block.b] == several_contacts) continue;
    const Vector3 friction = block.frame.col(1) * block.impulse[1] + block.frame.col(2) * block.impulse[2];
    const double time = block.bounces ? block.met : problem.length;
    const auto shift = [&](int place, double sign) {
      if (!free_to_drift(*problem.trees[place])) return;
      for (int k = 0; k < 3; ++k) step[problem.offset[place] + 3 + k] -= sign * time * friction[k] / problem.total_mass[place];
    };
    shift(block.a, 1);
    shift(block.b, -1);
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
    return b.kind == Block::Source::servo && b.is_obeyed() && std::abs(b.seek[0]) > rounding;
  });
}

/// Into how many parts the step of an island should be divided for what swings in it.
int parts_for_swings(std::span<const Swing> swings, std::span<const int> island) {
  constexpr double most = 0.1;  // in a part [rad]
  double angle = 0;
  for (const Swing& swing : swings) {
    if (std::ranges::find(island, swing.tree) != island.end()) angle = std::max(angle, swing.angle);
  }
  return static_cast<int>(std::ceil(std::min(angle / most, 1e6)));
}

}  // namespace

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
  const Outcome outcome = solve_velocities(problem_, solver_);
  std::size_t free = find_free(problem_, servos_, work_, free_velocities_, free_);
  const bool touched = free < free_.size();
  if (most_parts > 1) {
    const int parts = std::max({touched ? parts_for_tension(problem_, contacts_, work_, tension_) : 1, parts_for_nutation(problem_, work_),
                                parts_for_swings(swings, island)});
    if (parts > 1) {
      for (const int tree : island) watch_[tree] |= Watch::waits;
      report_.not_converged += parts > most_parts;
      return left.add(island, std::min(parts, most_parts));
    }
  }
  add(outcome, report_);
  const bool rebounding = rebounds(problem_);
  if (rebounding) bound_impacts(problem_, solver_, work_, rebound_);
  if (rebounding) free_.assign(free_.size(), free = 0);  // its energy is bounded as a whole
  if (free > 0) take_back_pushes(problem_, free_);
  write_impulses(problem_, contacts_, servos_, limits_);
  if (free > 0 && fly_free(first_tree, last_tree, first_item, last_item) && !problem_.two_stay_in()) return settle(first_tree, last_tree, false);
  const double before = energy_if_passive(problem_);
  note_excesses(problem_, work_, excesses_);
  take_velocities(problem_, free_, step_);
  wait_for_friction(problem_, contacts_, only_, step_);
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
      push_out(*problem_.trees[i], by);
    }
  }
  if (rebounding) bound_energy(problem_, work_, rebound_, step_);
  bound_gain(problem_, work_, before, grounded, is_part);
  const bool swept = outcome.sweeps > 0 && outcome.descents == 0;
  settle(first_tree, last_tree, rests, swept ? outcome.miss : 0);
}

}  // namespace ziggurat::dynamics
