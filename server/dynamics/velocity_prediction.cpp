// What a substep sets in motion: how fast it will be, before it is known what it meets.

#include <algorithm>
#include <cmath>

#include "dynamics/restitution_timing.h"
#include "dynamics/system.h"

namespace ziggurat::dynamics {
namespace {

/// Of an island that is looked at: a larger heap has no room to be thrown far.
constexpr int most_bodies = 64;
/// How far from a joint something may be that it turns [m].
constexpr double lever = 0.5;

/// What pushes on a tree give its links at most [m/s].
double push_speed(const Tree& tree, double length) {
  double most = 0;
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    if (tree.links[i].mass > 0) most = std::max(most, length * tree.external[i].force.norm() / tree.links[i].mass);
  }
  return most;
}

/// How fast a servo changes what it moves, if it is as strong as that takes [m/s].
/// @param least  what need not be known exactly
double servo_change(const Servo& servo, const Tree& tree, double least) {
  if (servo.dof < 0 || servo.upper <= 0) return 0;
  const double change = std::abs(servo.speed - tree.v[servo.dof]);
  return change <= least || tree.axes[servo.dof].angular.isZero(0) ? change : lever * change;
}

/// How fast two trees, or a tree and the world, part at a contact [m/s].
double parting(const std::vector<Tree>& trees, const Contact& contact) {
  const auto velocity = [&](const LinkIndex& side, const Vector3& point) -> Vector3 {
    if (side.tree < 0) return Vector3::Zero();
    const Motion& motion = trees[side.tree].motion[side.link];
    return motion.linear + motion.angular.cross(point - trees[side.tree].origin);
  };
  return contact.normal.dot(velocity(contact.a, contact.point) - velocity(contact.b, contact.point + contact.until_met));
}

/// Whether a joint reaches a limit within the substep, so fast that it matters.
bool strikes(const Limit& limit, const Tree& tree, double length, double least) {
  const int dof = joint_dof(tree, limit.link);
  const double q = tree.q[tree.first_place[limit.link]], speed = tree.v[dof], end = q + length * speed;
  if (end >= limit.lower && end <= limit.upper) return false;
  return std::abs(speed) * (tree.axes[dof].angular.isZero(0) ? 1 : lever) > least;
}

/// Notes which of the fast trees something strikes, or a joint's limit.
/// @param fast   of each tree
/// @param least  slower blows do not matter [m/s]
void find_blows(const std::vector<Tree>& trees, const std::vector<unsigned char>& fast, std::span<const Contact> contacts,
                std::span<const Limit> limits, double length, double least, std::vector<int>& out) {
  const auto is_fast = [&](int tree) { return tree >= 0 && fast[tree]; };
  const auto moves = [&](int tree) { return tree >= 0 && trees[tree].dofs > 0; };
  const auto throws = [&](int tree, const Contact& contact) {
    return is_fast(tree) && (contact.restitution > 0 || trees[tree].links.size() > 1 || (moves(contact.a.tree) && moves(contact.b.tree)));
  };
  for (const Contact& contact : contacts) {
    if (!throws(contact.a.tree, contact) && !throws(contact.b.tree, contact)) continue;
    const double apart = parting(trees, contact);
    if (-apart > least && contact.gap + length * apart < 0) out.push_back(is_fast(contact.a.tree) ? contact.a.tree : contact.b.tree);
  }
  for (const Limit& limit : limits) {
    if (is_fast(limit.tree) && strikes(limit, trees[limit.tree], length, least)) out.push_back(limit.tree);
  }
}

}  // namespace

bool System::foresee(std::span<Limit> limits, double far, std::span<const int> fast_trees, Foresight& out) {
  limits_ = limits;
  out.trees.clear();
  out.speeds.clear();
  const double fast = far / length_;
  const auto moves = [&](int tree) { return trees[tree].dofs > 0 && !asleep(tree); };
  disturbed_.clear();
  each_that_takes_part([&](int tree) {
    if ((watch_[tree] & pushed) && moves(tree) && push_speed(trees[tree], length_) > fast) disturbed_.push_back(tree);
  });
  for (const Servo& servo : servos_) {
    const Tree& tree = trees[servo.tree];
    if (servo_change(servo, tree, fast) > fast && moves(servo.tree)) disturbed_.push_back(servo.tree);
  }
  fast_.assign(fast_trees.empty() ? 0 : trees.size(), 0);
  for (const int tree : fast_trees) fast_[tree] = moves(tree);
  if (!fast_.empty()) find_blows(trees, fast_, contacts_, limits_, length_, fast, disturbed_);
  if (disturbed_.empty()) return false;
  find_awake();
  gather();
  for (int& tree : disturbed_) tree = island_[tree];
  std::ranges::sort(disturbed_);
  disturbed_.erase(std::unique(disturbed_.begin(), disturbed_.end()), disturbed_.end());
  for (const int island : disturbed_) {
    const int first = first_tree_[island], last = first_tree_[island + 1];
    if (last - first > most_bodies) continue;
    gather_island(first, last, first_item_[island], first_item_[island + 1]);
    solve_velocities(problem_, solver_);
    out.trees.insert(out.trees.end(), tree_order_.begin() + first, tree_order_.begin() + last);
    out.speeds.insert(out.speeds.end(), problem_.velocity.begin(), problem_.velocity.end());
  }
  return !out.trees.empty();
}

void swap_speeds(std::vector<Tree>& trees, Foresight& foresight) {
  auto next = foresight.speeds.begin();
  for (const int tree : foresight.trees) {
    next = std::swap_ranges(trees[tree].v.begin(), trees[tree].v.end(), next);
    move(trees[tree]);
  }
}

}  // namespace ziggurat::dynamics
