// Sleep of islands, and events that wake them.

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "dynamics/system.h"

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
bool is_slow(const std::vector<Tree>& trees, std::span<const int> island, const SleepOptions& rest) {
  for (const int number : island) {
    const Tree& tree = trees[number];
    for (int k = 0; k < tree.dofs; ++k) {
      const bool linear = tree.motion_subspace[k].angular.isZero(0);
      if (!(std::abs(tree.v[k]) <= (linear ? rest.linear_velocity : rest.angular_velocity))) return false;
    }
  }
  return true;
}

/// Whether the residual of an island's solution explains its kinetic energy.
bool is_below_residual(const std::vector<Tree>& trees, std::span<const int> island, const SleepOptions& rest,
              double miss) {
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

}  // namespace

void System::wake(int tree) {
  if (!is_asleep(tree)) return;
  while (sleep_ring_[tree] >= 0) {
    const int next = sleep_ring_[tree];
    sleep_ring_[tree] = -1;
    sleep_states_[tree].time_at_rest = 0;
    tree = next;
  }
}

void System::wake_all() {
  sleep_states_.assign(trees.size(), SleepState{});
  sleep_ring_.assign(trees.size(), -1);
}

void System::apply_wrench(int tree, int link, const Wrench& wrench) {
  Wrench& external = trees[tree].external[link];
  external = external + wrench;
  if (wake_flags_.size() < trees.size()) wake_flags_.resize(trees.size(), 0);
  wake_flags_[tree] |= loaded;
}

void System::clear_wrenches() {
  for_each_active([&](int tree) {
    if (wake_flags_[tree] & subdivided) {
      wake_flags_[tree] &= static_cast<unsigned char>(~subdivided);
      return;
    }
    if (!(wake_flags_[tree] & loaded)) return;
    wake_flags_[tree] &= static_cast<unsigned char>(~loaded);
    auto& external = trees[tree].external;
    std::fill(external.begin(), external.end(), Wrench{});
  });
}

/// Whether wrenches or commands of a sleeper have changed.
bool System::has_changed_load(int index) const {
  const SleepState& sleeper = sleep_states_[index];
  if (sleeper.command != sleeper.command_asleep) return true;
  const Tree& tree = trees[index];
  const double bound = sleeper.force_bound;
  for (std::size_t i = 0; i < tree.external.size(); ++i) {
    const Wrench change = tree.external[i] - tree.external_at_sleep[i];
    if (change.force.squaredNorm() > bound * bound) return true;
    if (change.moment.squaredNorm() > bound * bound * 1e-4) return true;
  }
  return false;
}

/// Whether the awake side of a contact may touch the sleeping one within the substep.
bool System::comes_to_touch(const ContactPoint& contact) const {
  const auto speed = [&](const LinkIndex& side) -> Vector3 {
    if (side.tree < 0 || is_asleep(side.tree)) return Vector3::Zero();
    const Tree& tree = trees[side.tree];
    const Motion& motion = tree.spatial_velocity[side.link];
    return motion.linear + motion.angular.cross(contact.point - tree.origin);
  };
  const double apart = contact.normal.dot(speed(contact.a) - speed(contact.b));
  const int mover =
      contact.a.tree >= 0 && !is_asleep(contact.a.tree) ? contact.a.tree : contact.b.tree;
  if (mover < 0) return contact.gap + time_step_ * apart < 1e-5;
  const Tree& tree = trees[mover];
  double faster = 2 * tree.gravity.norm() * time_step_;
  if (wake_flags_[mover] & loaded) {
    faster += wrench_velocity_change(tree, (contact.point - tree.origin).norm(), time_step_);
  }
  if (wake_flags_[mover] & commanded) {
    const auto is_its = [&](int i) {  // its old servo's number may belong to another tree now
      return i >= 0 && i < static_cast<int>(servos_.size()) && servos_[i].tree == mover;
    };
    for (int i = sleep_states_[mover].first_servo; is_its(i); i = next_servo_[i]) {
      faster += servo_velocity_change(tree, servos_[i], contact.point);
    }
  }
  return contact.gap + time_step_ * (apart - faster) < 1e-5;
}

/// Hashes the commands of each tree's servos, and lists its servos.
void System::hash_servo_commands() {
  for (const Servo& servo : servos_) {
    if (servo.tree < 0) continue;
    sleep_states_[servo.tree].command = 0;
    sleep_states_[servo.tree].first_servo = -1;
  }
  next_servo_.resize(servos_.size());
  for (std::size_t i = 0; i < servos_.size(); ++i) {
    const Servo& servo = servos_[i];
    if (servo.tree < 0) continue;
    wake_flags_[servo.tree] |= commanded;
    SleepState& sleeper = sleep_states_[servo.tree];
    next_servo_[i] = std::exchange(sleeper.first_servo, static_cast<int>(i));
    std::uint64_t& command = sleeper.command;
    for (const double number : {servo.target_velocity, servo.lower, servo.upper}) command = hash_combine(command, number);
  }
}

bool System::wake_disturbed(double time_step, std::span<ContactPoint> contacts, std::span<Servo> servos, std::span<const int> chosen) {
  time_step_ = time_step;
  active_ = chosen;
  servos_ = servos;
  contacts_ = contacts;
  list_contact_trees(contacts_, contact_trees_);
  if (sleep_states_.size() > trees.size()) wake_all();
  sleep_states_.resize(trees.size());
  sleep_ring_.resize(trees.size(), -1);
  wake_flags_.resize(trees.size(), 0);
  hash_servo_commands();
  bool woke = false;
  for_each_active([&](int tree) {
    if (wake_flags_[tree] == 0 || !is_asleep(tree) || !has_changed_load(tree)) return;
    wake(tree);
    woke = true;
  });
  const auto moves = [&](int tree) { return trees[tree].dofs > 0; };
  for (bool again = true; again;) {  // who wakes may touch another
    again = false;
    for (std::size_t i = 0; i < contact_trees_.size(); ++i) {
      const auto [a, b] = contact_trees_[i];
      if (a < 0 || b < 0 || is_asleep(a) == is_asleep(b)) continue;  // most, and this reads no tree
      if (!moves(a) || !moves(b) || !comes_to_touch(contacts_[i])) continue;
      wake(a);
      wake(b);
      again = woke = true;
    }
  }
  return woke;
}

/// Lets an island sleep that has been below the bounds for long enough.
/// @param carried     whether the world supports it
/// @param heap_residual  residual of its solution if it was solved by passes only [m/s]; else 0
void System::update_sleep(int first_tree, int last_tree, bool carried, double heap_residual) {
  if (!sleeping.enabled) return;
  const std::span<const int> island(tree_order_.data() + first_tree,
                                    tree_order_.data() + last_tree);
  const bool is_heap = heap_residual > 0;
  const bool quiet = carried && ((is_heap && is_below_residual(trees, island, sleeping, heap_residual)) ||
                                 is_slow(trees, island, sleeping));
  double least = HUGE_VAL;
  for (int i = first_tree; i < last_tree; ++i) {
    SleepState& sleeper = sleep_states_[tree_order_[i]];
    sleeper.time_at_rest = quiet ? sleeper.time_at_rest + time_step_ : 0;
    least = std::min(least, sleeper.time_at_rest);
  }
  if (!quiet || least < (is_heap ? sleeping.heap_time : sleeping.time)) return;
  for (int i = first_tree; i < last_tree; ++i) {
    const int index = tree_order_[i];
    Tree& tree = trees[index];
    SleepState& sleeper = sleep_states_[index];
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
    sleep_ring_[index] = i + 1 < last_tree ? tree_order_[i + 1] : tree_order_[first_tree];
    sleeper.command_asleep = sleeper.command;
    wake_flags_[index] = static_cast<unsigned char>((wake_flags_[index] & ~loaded_asleep) | (is_held ? loaded_asleep : 0));
    sleeper.force_bound = sleeping.force_change * (mass * tree.gravity.norm() + force);
  }
}

}  // namespace ziggurat::dynamics
