// SPDX-License-Identifier: MIT
// Sleep of islands, and events that wake them.

#include "physics/stepping/sleeping.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace ziggurat::dynamics {
namespace {

/// Combines a hash with a number.
std::uint64_t hash_combine(std::uint64_t hash, double number) {
  const double unsigned_zero = number + 0.0;
  hash = (hash ^ std::bit_cast<std::uint64_t>(unsigned_zero)) * 0x9E3779B97F4A7C15U;
  return hash ^ (hash >> 29);
}

/// Whether all coordinates of an island are below the bounds of sleep.
/// @param island  numbers of its trees
bool is_slow(const std::vector<Tree>& trees, std::span<const int> island,
             const SleepOptions& rest) {
  for (const int number : island) {
    const Tree& tree = trees[number];
    for (int k = 0; k < tree.dofs; ++k) {
      const bool linear = tree.motion_subspace[k].angular.isZero(0);
      if (!(std::abs(tree.v[k]) <= (linear ? rest.linear_velocity : rest.angular_velocity)))
        return false;
    }
  }
  return true;
}

/// Whether the residual of an island's solution explains its kinetic energy.
bool is_below_residual(const std::vector<Tree>& trees, std::span<const int> island,
                       const SleepOptions& rest, double miss) {
  double energy = 0, mass = 0;
  for (const int number : island) {
    double own = 0;
    for (const Link& link : trees[number].links) own += link.mass;
    const double its = kinetic_energy(trees[number]);
    if (!(2 * its <= own * rest.heap_fastest * rest.heap_fastest)) return false;
    energy += its, mass += own;
  }
  constexpr double some = 3;  // several contacts' residuals add up on a body
  const double most = std::min(some * miss, rest.heap_velocity);
  return 2 * energy <= mass * most * most;
}

/// Velocity change of a point of a link by the tree's wrenches within a substep.
/// @param reach  distance of the point from the tree's origin [m]
double wrench_velocity_change(const Tree& tree, double reach, double time_step) {
  double sum = 0;
  for (std::size_t i = 0; i < tree.external.size(); ++i) {
    const Link& link = tree.links[i];
    const Wrench& push = tree.external[i];
    if (link.mass <= 0) continue;
    sum += push.force.norm() / link.mass + push.moment.norm() * reach / link.inertia.minCoeff();
  }
  return time_step * sum;
}

/// Velocity change of a point by a servo that reaches its target.
double servo_velocity_change(const Tree& tree, const Servo& servo, const Vector3& point) {
  const Motion axis = servo.dof >= 0 ? tree.motion_subspace[servo.dof] : servo.direction;
  const double now = servo.dof >= 0 ? tree.v[servo.dof]
                                    : axis.linear.dot(tree.velocity(servo.link)) +
                                          axis.angular.dot(tree.angular_velocity(servo.link));
  const double reach = (point - tree.origin).norm();
  return std::abs(servo.target_velocity - now) * (axis.linear.norm() + axis.angular.norm() * reach);
}

/// Whether wrenches or commands of a sleeper have changed.
bool has_changed_load(const SleepState& sleeper, const Tree& tree) {
  if (sleeper.command != sleeper.command_asleep) return true;
  const double bound = sleeper.force_bound;
  for (std::size_t i = 0; i < tree.external.size(); ++i) {
    const Wrench change = tree.external[i] - tree.external_at_sleep[i];
    if (change.force.squaredNorm() > bound * bound) return true;
    if (change.moment.squaredNorm() > bound * bound * 1e-4) return true;
  }
  return false;
}

/// Whether the awake side of a contact may touch the sleeping one within the substep.
bool comes_to_touch(const Sleep& sleep, const std::vector<Tree>& trees,
                    std::span<const Servo> servos, const ContactPoint& contact, double time_step) {
  const auto speed = [&](const LinkIndex& side) -> Vector3 {
    if (side.tree < 0 || sleep.is_asleep(side.tree)) return Vector3::Zero();
    const Tree& tree = trees[side.tree];
    const Motion& motion = tree.spatial_velocity[side.link];
    return motion.linear + motion.angular.cross(contact.point - tree.origin);
  };
  const double apart = contact.normal.dot(speed(contact.a) - speed(contact.b));
  const int mover =
      contact.a.tree >= 0 && !sleep.is_asleep(contact.a.tree) ? contact.a.tree : contact.b.tree;
  if (mover < 0) return contact.gap + time_step * apart < 1e-5;
  const Tree& tree = trees[mover];
  double faster = 2 * tree.gravity.norm() * time_step;
  if (sleep.flags[mover] & Sleep::loaded) {
    faster += wrench_velocity_change(tree, (contact.point - tree.origin).norm(), time_step);
  }
  if (sleep.flags[mover] & Sleep::commanded) {
    const auto is_its = [&](int i) {  // its old servo's number may belong to another tree now
      return i >= 0 && i < static_cast<int>(servos.size()) && servos[i].tree == mover;
    };
    for (int i = sleep.states[mover].first_servo; is_its(i); i = sleep.next_servo[i]) {
      faster += servo_velocity_change(tree, servos[i], contact.point);
    }
  }
  return contact.gap + time_step * (apart - faster) < 1e-5;
}

/// Hashes the commands of each tree's servos, and lists its servos; a grip is no command.
void hash_servo_commands(Sleep& sleep, std::span<const Servo> servos) {
  for (const Servo& servo : servos) {
    if (servo.tree < 0 || servo.other.tree >= 0) continue;
    sleep.states[servo.tree].command = 0;
    sleep.states[servo.tree].first_servo = -1;
  }
  sleep.next_servo.resize(servos.size());
  for (std::size_t i = 0; i < servos.size(); ++i) {
    const Servo& servo = servos[i];
    if (servo.tree < 0 || servo.other.tree >= 0) continue;
    set_flag(sleep, servo.tree, Sleep::commanded);
    SleepState& sleeper = sleep.states[servo.tree];
    sleep.next_servo[i] = std::exchange(sleeper.first_servo, static_cast<int>(i));
    std::uint64_t& command = sleeper.command;
    for (const double number : {servo.target_velocity, servo.lower, servo.upper})
      command = hash_combine(command, number);
  }
}

}  // namespace

void set_flag(Sleep& sleep, int tree, Sleep::Flag flag) {
  unsigned char& flags = sleep.flags[tree];
  if (flags == 0) sleep.flagged.push_back(tree);
  flags |= flag;
}

void list_flagged(Sleep& sleep) {
  sleep.flagged.clear();
  for (std::size_t i = 0; i < sleep.flags.size(); ++i) {
    if (sleep.flags[i] != 0) sleep.flagged.push_back(static_cast<int>(i));
  }
}

void list_awake(Sleep& sleep, std::size_t trees) {
  if (sleep.listed == sleep.changes && sleep.tree_count == trees) return;
  sleep.listed = sleep.changes;
  sleep.tree_count = trees;
  sleep.awake.clear();
  for (int tree = 0; tree < static_cast<int>(trees); ++tree) {
    if (!sleep.is_asleep(tree)) sleep.awake.push_back(tree);
  }
}

void wake(Sleep& sleep, int tree) {
  if (!sleep.is_asleep(tree)) return;
  ++sleep.changes;
  while (sleep.ring[tree] >= 0) {
    const int next = sleep.ring[tree];
    sleep.ring[tree] = -1;
    sleep.states[tree].time_at_rest = 0;
    tree = next;
  }
}

void wake_all(Sleep& sleep, std::size_t trees) {
  ++sleep.changes;
  sleep.states.assign(trees, SleepState{});
  sleep.ring.assign(trees, -1);
}

bool wake_disturbed(Sleep& sleep, const std::vector<Tree>& trees, std::span<const int> active,
                    const ConstraintLists& constraints, double time_step) {
  if (sleep.states.size() > trees.size()) wake_all(sleep, trees.size());
  sleep.states.resize(trees.size());
  sleep.ring.resize(trees.size(), -1);
  if (sleep.flags.size() != trees.size()) {
    sleep.flags.resize(trees.size(), 0);
    list_flagged(sleep);
  }
  hash_servo_commands(sleep, constraints.servos);
  bool woke = false;
  for_each_flagged(sleep, active, [&](int tree) {
    if (sleep.flags[tree] == 0 || !sleep.is_asleep(tree) ||
        !has_changed_load(sleep.states[tree], trees[tree]))
      return;
    wake(sleep, tree);
    woke = true;
  });
  const auto moves = [&](int tree) { return trees[tree].dofs > 0; };
  for (bool again = true; again;) {  // a tree that wakes may touch another
    again = false;
    for (std::size_t i = 0; i < constraints.contact_trees.size(); ++i) {
      const auto [a, b] = constraints.contact_trees[i];
      if (a < 0 || b < 0 || sleep.is_asleep(a) == sleep.is_asleep(b))
        continue;  // most, and this reads no tree
      if (!moves(a) || !moves(b) ||
          !comes_to_touch(sleep, trees, constraints.servos, constraints.contacts[i], time_step))
        continue;
      wake(sleep, a);
      wake(sleep, b);
      again = woke = true;
    }
  }
  return woke;
}

bool is_quiet(const SleepOptions& options, const std::vector<Tree>& trees,
              std::span<const int> island, double heap_residual) {
  return options.enabled &&
         ((heap_residual > 0 && is_below_residual(trees, island, options, heap_residual)) ||
          is_slow(trees, island, options));
}

void update_sleep(Sleep& sleep, const SleepOptions& options, std::vector<Tree>& trees,
                  std::span<const int> island, double time_step, bool is_quiet,
                  double heap_residual) {
  if (!options.enabled) return;
  double least = HUGE_VAL;
  for (const int index : island) {
    SleepState& sleeper = sleep.states[index];
    sleeper.time_at_rest = is_quiet ? sleeper.time_at_rest + time_step : 0;
    least = std::min(least, sleeper.time_at_rest);
  }
  if (!is_quiet || least < (heap_residual > 0 ? options.heap_time : options.time)) return;
  ++sleep.changes;
  for (std::size_t i = 0; i < island.size(); ++i) {
    const int index = island[i];
    Tree& tree = trees[index];
    SleepState& sleeper = sleep.states[index];
    std::fill(tree.v.begin(), tree.v.end(), 0.0);
    velocity_kinematics(tree);
    tree.external_at_sleep = tree.external;
    double mass = 0, force = 0;
    bool is_held = false;
    for (const Link& link : tree.links) mass += link.mass;
    for (const Wrench& wrench : tree.external) {
      force += wrench.force.norm();
      is_held |= !wrench.force.isZero(0) || !wrench.moment.isZero(0);
    }
    sleep.ring[index] = island[(i + 1) % island.size()];
    sleeper.command_asleep = sleeper.command;
    sleep.flags[index] &= static_cast<unsigned char>(~Sleep::loaded_asleep);
    if (is_held) set_flag(sleep, index, Sleep::loaded_asleep);
    sleeper.force_bound = options.force_change * (mass * tree.gravity.norm() + force);
  }
}

}  // namespace ziggurat::dynamics
