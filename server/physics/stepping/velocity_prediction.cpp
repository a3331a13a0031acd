// SPDX-License-Identifier: MIT
// Prediction of velocities within a substep, before contacts are found.

#include <algorithm>
#include <cmath>

#include "physics/stepping/system.h"

namespace ziggurat::dynamics {
namespace {

/// Largest island that is predicted: larger heaps leave bodies no room.
constexpr std::size_t most_bodies = 64;
/// Typical distance of an obstacle from a revolute joint [m].
constexpr double lever = 0.5;

/// Largest velocity change of a tree's links by external wrenches [m/s].
double wrench_velocity(const Tree& tree, double time_step) {
  double most = 0;
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    if (tree.links[i].mass > 0)
      most = std::max(most, time_step * tree.external[i].force.norm() / tree.links[i].mass);
  }
  return most;
}

/// Velocity change that a servo asks for, if it is strong enough [m/s].
/// @param least  smaller changes are not scaled by the lever
double servo_change(const Servo& servo, const Tree& tree, double least) {
  if (servo.dof < 0 || servo.upper <= 0) return 0;
  const double change = std::abs(servo.target_velocity - tree.v[servo.dof]);
  return change <= least || tree.motion_subspace[servo.dof].angular.isZero(0) ? change
                                                                              : lever * change;
}

/// Separation velocity of two trees, or a tree and the world, at a contact [m/s].
double separation_velocity(const std::vector<Tree>& trees, const ContactPoint& contact) {
  const auto velocity = [&](const LinkIndex& side, const Vector3& point) -> Vector3 {
    if (side.tree < 0) return Vector3::Zero();
    const Motion& motion = trees[side.tree].spatial_velocity[side.link];
    return motion.linear + motion.angular.cross(point - trees[side.tree].origin);
  };
  return contact.normal.dot(velocity(contact.a, contact.point) -
                            velocity(contact.b, contact.point + contact.offset_to_b));
}

/// Whether a joint reaches a limit within the substep faster than a threshold.
bool strikes_limit(const Limit& limit, const Tree& tree, double time_step, double least) {
  const int dof = joint_dof(tree, limit.link);
  const double q = tree.q[tree.first_position[limit.link]], speed = tree.v[dof],
               end = q + time_step * speed;
  if (end >= limit.lower && end <= limit.upper) return false;
  return std::abs(speed) * (tree.motion_subspace[dof].angular.isZero(0) ? 1 : lever) > least;
}

/// Finds the fast trees that have an impact with another one or a limit.
/// @param fast   of each tree
/// @param least  slower impacts are ignored [m/s]
void find_impacts(const std::vector<Tree>& trees, const std::vector<unsigned char>& fast,
                  std::span<const ContactPoint> contacts, std::span<const Limit> limits,
                  double time_step, double least, std::vector<int>& out) {
  const auto is_fast = [&](int tree) { return tree >= 0 && fast[tree]; };
  const auto moves = [&](int tree) { return tree >= 0 && trees[tree].dofs > 0; };
  const auto throws = [&](int tree, const ContactPoint& contact) {
    return is_fast(tree) && (contact.restitution > 0 || trees[tree].links.size() > 1 ||
                             (moves(contact.a.tree) && moves(contact.b.tree)));
  };
  for (const ContactPoint& contact : contacts) {
    if (!throws(contact.a.tree, contact) && !throws(contact.b.tree, contact)) continue;
    const double apart = separation_velocity(trees, contact);
    if (-apart > least && contact.gap + time_step * apart < 0)
      out.push_back(is_fast(contact.a.tree) ? contact.a.tree : contact.b.tree);
  }
  for (const Limit& limit : limits) {
    if (is_fast(limit.tree) && strikes_limit(limit, trees[limit.tree], time_step, least))
      out.push_back(limit.tree);
  }
}

}  // namespace

bool System::predict_velocities(std::span<Limit> limits, double far,
                                std::span<const int> fast_trees, PredictedVelocities& out) {
  constraints_.limits = limits;
  out.trees.clear();
  out.velocities.clear();
  const double fast = far / time_step_;
  const auto moves = [&](int tree) { return trees[tree].dofs > 0 && !is_asleep(tree); };
  disturbed_.clear();
  for_each_flagged(sleep_, active_, [&](int tree) {
    if ((sleep_.flags[tree] & Sleep::loaded) && moves(tree) &&
        wrench_velocity(trees[tree], time_step_) > fast)
      disturbed_.push_back(tree);
  });
  for (const Servo& servo : constraints_.servos) {
    const Tree& tree = trees[servo.tree];
    if (servo_change(servo, tree, fast) > fast && moves(servo.tree))
      disturbed_.push_back(servo.tree);
  }
  is_fast_.assign(fast_trees.empty() ? 0 : trees.size(), 0);
  for (const int tree : fast_trees) is_fast_[tree] = moves(tree);
  if (!is_fast_.empty())
    find_impacts(trees, is_fast_, constraints_.contacts, limits, time_step_, fast, disturbed_);
  if (disturbed_.empty()) return false;
  find_islands();
  for (int& tree : disturbed_) tree = islands_.of_tree[tree];
  std::ranges::sort(disturbed_);
  disturbed_.erase(std::unique(disturbed_.begin(), disturbed_.end()), disturbed_.end());
  IslandMemory& memory = memories_.front();
  Report report;
  for (const int number : disturbed_) {
    const IslandStep step = island_step(number, memory, report);
    if (step.island.trees.size() > most_bodies) continue;
    assemble_problem(step);
    solve_velocities(memory.problem, memory.solver);
    write_impulses(memory.problem, constraints_);
    out.trees.insert(out.trees.end(), step.island.trees.begin(), step.island.trees.end());
    out.velocities.insert(out.velocities.end(), memory.problem.velocity.begin(),
                          memory.problem.velocity.end());
  }
  return !out.trees.empty();
}

void swap_velocities(std::vector<Tree>& trees, PredictedVelocities& prediction) {
  auto next = prediction.velocities.begin();
  for (const int tree : prediction.trees) {
    next = std::swap_ranges(trees[tree].v.begin(), trees[tree].v.end(), next);
    velocity_kinematics(trees[tree]);
  }
}

}  // namespace ziggurat::dynamics
