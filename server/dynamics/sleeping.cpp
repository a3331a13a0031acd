// Islands that rest sleep: which do, and what wakes them.

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "dynamics/system.h"

namespace ziggurat::dynamics {
namespace {

/// A hash of numbers, one after the other: it changes with each of them.
std::uint64_t mixed(std::uint64_t hash, double number) {
  const double unsigned_zero = number + 0.0;
  hash = (hash ^ std::bit_cast<std::uint64_t>(unsigned_zero)) * 0x9E3779B97F4A7C15U;
  return hash ^ (hash >> 29);
}

/// Whether all coordinates of an island are so slow that it rests.
/// @param island  numbers of its trees
bool is_slow(const std::vector<Tree>& trees, std::span<const int> island, const RestOptions& rest) {
  for (const int number : island) {
    const Tree& tree = trees[number];
    for (int k = 0; k < tree.dofs; ++k) {
      const bool linear = tree.axes[k].angular.isZero(0);
      if (!(std::abs(tree.v[k]) <= (linear ? rest.speed : rest.turning))) return false;
    }
  }
  return true;
}

/// Whether an island's kinetic energy is what the miss of its solution may have given it.
bool is_noise(const std::vector<Tree>& trees, std::span<const int> island, const RestOptions& rest,
              double miss) {
  double energy = 0, mass = 0;
  for (const int number : island) {
    double own = 0;
    for (const Link& link : trees[number].links) own += link.mass;
    const double its = kinetic_energy(trees[number]);
    if (!(2 * its <= own * rest.swept_fastest * rest.swept_fastest)) return false;
    energy += its, mass += own;
  }
  constexpr double some = 3;  // each is pushed by the misses of several contacts
  const double most = std::min(some * miss, rest.swept_speed);
  return 2 * energy <= mass * most * most;
}

/// How much faster a point of a link may become within a substep by what pushes its tree.
/// @param reach  distance of the point from the tree's origin [m]
double pushed_faster(const Tree& tree, double reach, double length) {
  double sum = 0;
  for (std::size_t i = 0; i < tree.external.size(); ++i) {
    const Link& link = tree.links[i];
    const Wrench& push = tree.external[i];
    if (link.mass <= 0) continue;
    sum += push.force.norm() / link.mass + push.moment.norm() * reach / link.inertia.minCoeff();
  }
  return length * sum;
}

/// The same by a servo that reaches its speed.
double driven_faster(const Tree& tree, const Servo& servo, const Vector3& point) {
  const Motion axis = servo.dof >= 0 ? tree.axes[servo.dof] : servo.direction;
  const double now = servo.dof >= 0 ? tree.v[servo.dof]
                                    : axis.linear.dot(tree.velocity(servo.link)) +
                                          axis.angular.dot(tree.angular_velocity(servo.link));
  const double reach = (point - tree.origin).norm();
  return std::abs(servo.speed - now) * (axis.linear.norm() + axis.angular.norm() * reach);
}

}  // namespace

void System::wake(int tree) {
  if (!asleep(tree)) return;
  while (next_[tree] >= 0) {
    const int next = next_[tree];
    next_[tree] = -1;
    sleepers_[tree].quiet = 0;
    tree = next;
  }
}

void System::wake_all() {
  sleepers_.assign(trees.size(), Sleeper{});
  next_.assign(trees.size(), -1);
}

void System::push(int tree, int link, const Wrench& wrench) {
  Wrench& external = trees[tree].external[link];
  external = external + wrench;
  if (watch_.size() < trees.size()) watch_.resize(trees.size(), 0);
  watch_[tree] |= pushed;
}

void System::forget_pushes() {
  each_that_takes_part([&](int tree) {
    if (watch_[tree] & waits) {
      watch_[tree] &= static_cast<unsigned char>(~waits);
      return;
    }
    if (!(watch_[tree] & pushed)) return;
    watch_[tree] &= static_cast<unsigned char>(~pushed);
    auto& external = trees[tree].external;
    std::fill(external.begin(), external.end(), Wrench{});
  });
}

/// Whether what acts on a sleeper is no longer what it was.
bool System::changed(int index) const {
  const Sleeper& sleeper = sleepers_[index];
  if (sleeper.command != sleeper.command_asleep) return true;
  const Tree& tree = trees[index];
  const double bound = sleeper.force_bound;
  for (std::size_t i = 0; i < tree.external.size(); ++i) {
    const Wrench change = tree.external[i] - tree.held_by[i];
    if (change.force.squaredNorm() > bound * bound) return true;
    if (change.moment.squaredNorm() > bound * bound * 1e-4) return true;
  }
  return false;
}

/// Whether the awake side of a contact may touch the sleeping one within the substep.
bool System::comes_to_touch(const Contact& contact) const {
  const auto speed = [&](const LinkIndex& side) -> Vector3 {
    if (side.tree < 0 || asleep(side.tree)) return Vector3::Zero();
    const Tree& tree = trees[side.tree];
    const Motion& motion = tree.motion[side.link];
    return motion.linear + motion.angular.cross(contact.point - tree.origin);
  };
  const double apart = contact.normal.dot(speed(contact.a) - speed(contact.b));
  const int mover =
      contact.a.tree >= 0 && !asleep(contact.a.tree) ? contact.a.tree : contact.b.tree;
  if (mover < 0) return contact.gap + length_ * apart < 1e-5;
  const Tree& tree = trees[mover];
  double faster = 2 * tree.gravity.norm() * length_;
  if (watch_[mover] & pushed) {
    faster += pushed_faster(tree, (contact.point - tree.origin).norm(), length_);
  }
  if (watch_[mover] & commanded) {
    const auto is_its = [&](int i) {  // what it had before may be the servo of another now
      return i >= 0 && i < static_cast<int>(servos_.size()) && servos_[i].tree == mover;
    };
    for (int i = sleepers_[mover].first_servo; is_its(i); i = next_servo_[i]) {
      faster += driven_faster(tree, servos_[i], contact.point);
    }
  }
  return contact.gap + length_ * (apart - faster) < 1e-5;
}

/// One number per tree that changes with the commands of its servos, and which they are.
void System::note_commands() {
  for (const Servo& servo : servos_) {
    if (servo.tree < 0) continue;
    sleepers_[servo.tree].command = 0;
    sleepers_[servo.tree].first_servo = -1;
  }
  next_servo_.resize(servos_.size());
  for (std::size_t i = 0; i < servos_.size(); ++i) {
    const Servo& servo = servos_[i];
    if (servo.tree < 0) continue;
    watch_[servo.tree] |= commanded;
    Sleeper& sleeper = sleepers_[servo.tree];
    next_servo_[i] = std::exchange(sleeper.first_servo, static_cast<int>(i));
    std::uint64_t& command = sleeper.command;
    for (const double number : {servo.speed, servo.lower, servo.upper}) command = mixed(command, number);
  }
}

bool System::wake_disturbed(double length, std::span<Contact> contacts, std::span<Servo> servos, std::span<const int> chosen) {
  length_ = length;
  chosen_ = chosen;
  servos_ = servos;
  contacts_ = contacts;
  note_ends(contacts_, ends_);
  if (sleepers_.size() > trees.size()) wake_all();
  sleepers_.resize(trees.size());
  next_.resize(trees.size(), -1);
  watch_.resize(trees.size(), 0);
  note_commands();
  bool woke = false;
  each_that_takes_part([&](int tree) {
    if (watch_[tree] == 0 || !asleep(tree) || !changed(tree)) return;
    wake(tree);
    woke = true;
  });
  const auto moves = [&](int tree) { return trees[tree].dofs > 0; };
  for (bool again = true; again;) {  // who wakes may touch another
    again = false;
    for (std::size_t i = 0; i < ends_.size(); ++i) {
      const auto [a, b] = ends_[i];
      if (a < 0 || b < 0 || asleep(a) == asleep(b)) continue;  // most, and this reads no tree
      if (!moves(a) || !moves(b) || !comes_to_touch(contacts_[i])) continue;
      wake(a);
      wake(b);
      again = woke = true;
    }
  }
  return woke;
}

/// Lets an island sleep that has been at rest for long enough.
/// @param carried     whether the world carries it
/// @param swept_miss  by how much its solution misses the law, if it was only swept [m/s]; else 0
void System::settle(int first_tree, int last_tree, bool carried, double swept_miss) {
  if (!rest.sleeps) return;
  const std::span<const int> island(tree_order_.data() + first_tree,
                                    tree_order_.data() + last_tree);
  const bool swept = swept_miss > 0;
  const bool quiet = carried && ((swept && is_noise(trees, island, rest, swept_miss)) ||
                                 is_slow(trees, island, rest));
  double least = HUGE_VAL;
  for (int i = first_tree; i < last_tree; ++i) {
    Sleeper& sleeper = sleepers_[tree_order_[i]];
    sleeper.quiet = quiet ? sleeper.quiet + length_ : 0;
    least = std::min(least, sleeper.quiet);
  }
  if (!quiet || least < (swept ? rest.swept_time : rest.time)) return;
  for (int i = first_tree; i < last_tree; ++i) {
    const int index = tree_order_[i];
    Tree& tree = trees[index];
    Sleeper& sleeper = sleepers_[index];
    std::fill(tree.v.begin(), tree.v.end(), 0.0);
    move(tree);
    tree.held_by = tree.external;
    double mass = 0, force = 0;
    bool is_held = false;
    for (const Link& link : tree.links) mass += link.mass;
    for (const Wrench& wrench : tree.external) {
      force += wrench.force.norm();
      is_held |= !wrench.force.isZero(0) || !wrench.moment.isZero(0);
    }
    next_[index] = i + 1 < last_tree ? tree_order_[i + 1] : tree_order_[first_tree];
    sleeper.command_asleep = sleeper.command;
    watch_[index] = static_cast<unsigned char>((watch_[index] & ~held) | (is_held ? held : 0));
    sleeper.force_bound = rest.force * (mass * tree.gravity.norm() + force);
  }
}

}  // namespace ziggurat::dynamics
