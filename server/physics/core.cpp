// SPDX-License-Identifier: MIT
#include "physics/core.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "physics/bodies/convert.h"
#include "physics/build.h"
#include "physics/collision/colliders.h"

namespace ziggurat::physics {
namespace {

/// Clears the dialect's default damping: it is meant for its own clock.
void clear_default_damping(Body& body, const scene::Physics& physics) {
  if (physics.clock != scene::Clock::nominal) return;
  for (LinkBody& link : body.links) {
    if (link.damping.usual_linear) link.damping.linear = 0;
    if (link.damping.usual_angular) link.damping.angular = 0;
  }
}

std::vector<CoordinateJoint> coordinate_joints_of(const scene::Entity& entity, const Body& body) {
  std::vector<CoordinateJoint> made;
  for (std::size_t i = 0; i < entity.joints.size(); ++i) {
    const scene::Joint& joint = entity.joints[i];
    if (!scene::has_coordinate(joint.type)) continue;
    CoordinateJoint& moving = made.emplace_back();
    moving.entity = body.entity;
    moving.index = i;
    moving.part = body.links[joint.child].part;
    moving.limit = joint.limit;
  }
  return made;
}

/// Joints of an entity: joints stand in the order of their entities.
std::span<CoordinateJoint> joints_of(std::size_t entity, std::vector<CoordinateJoint>& joints) {
  return {std::ranges::lower_bound(joints, entity, {}, &CoordinateJoint::entity),
          std::ranges::upper_bound(joints, entity, {}, &CoordinateJoint::entity)};
}

/// Shares models with recent entities: equal ones mostly follow each other, or alternate with a few
/// others.
void share_mechanism(dynamics::Tree& tree, const std::vector<dynamics::Tree>& trees) {
  constexpr std::size_t most = 8;
  for (std::size_t i = 0; i < std::min(most, trees.size()); ++i) {
    if (tree.share_model(trees[trees.size() - 1 - i])) return;
  }
}

}  // namespace

NewtonCore::NewtonCore(const scene::Physics& physics) : settings_(physics) {
  colliders_.gravity = std::abs(physics.gravity.value_or(0));
}

void NewtonCore::set_threads(unsigned threads) {
  system_.set_threads(threads);
  colliders_.team = system_.team();
  contacts_.set_team(system_.team());
}

Body NewtonCore::add(const scene::Entity& entity, std::size_t number) {
  Body body = make_body(entity, settings_, number);
  clear_default_damping(body, settings_);
  dynamics::Tree tree = make_tree(body, entity, settings_);
  const std::vector<CoordinateJoint> joints = coordinate_joints_of(entity, body);
  share_mechanism(tree, system_.trees);
  make_room(system_.trees, 1);
  make_room(joints_, joints.size());
  make_room(ground_servos_, 1);
  make_room(leapfrog_sync_.of_tree, 1);
  colliders_.add(body, entity, tree);
  system_.trees.push_back(std::move(tree));
  leapfrog_sync_.of_tree.push_back(LeapfrogSync::unknown);
  joints_.insert(joints_.end(), joints.begin(), joints.end());
  if (body.ground && entity.movable) ground_servos_.push_back({number, {}});
  body.articulation = Articulation{&system_, number};
  return body;
}

void NewtonCore::grip(std::span<const Body> bodies, std::size_t entity, const Gripper& gripper) {
  const bool moves = std::ranges::binary_search(ground_servos_, entity, {}, &GroundServo::entity);
  if (!moves || grip_of(entity)) return;
  const std::optional<Grip> found = find_grip(bodies[entity], gripper, bodies, colliders_, system_);
  if (!found) return;
  grips_.insert(std::ranges::lower_bound(grips_, entity, {}, &Grip::entity), *found);
  for (const std::size_t tree : {entity, found->held}) system_.wake(static_cast<int>(tree));
}

void NewtonCore::release(std::size_t entity) {
  const Grip* const grip = grip_of(entity);
  if (!grip) return;
  for (const std::size_t tree : {entity, grip->held}) system_.wake(static_cast<int>(tree));
  grips_.erase(grips_.begin() + (grip - grips_.data()));
}

const Grip* NewtonCore::grip_of(std::size_t entity) const {
  const auto found = std::ranges::lower_bound(grips_, entity, {}, &Grip::entity);
  return found != grips_.end() && found->entity == entity ? &*found : nullptr;
}

void NewtonCore::end_grips(std::span<Body> bodies) {
  for (Grip& grip : grips_) {
    if (!grip.is_torn) end_substep(grip, bodies);
  }
}

/// Ends grips of an entity and on it.
void NewtonCore::end_grips_with(std::size_t entity) {
  for (std::size_t i = grips_.size(); i-- > 0;) {
    if (grips_[i].entity == entity || grips_[i].held == entity) release(grips_[i].entity);
  }
}

void NewtonCore::detach(std::size_t entity) {
  end_grips_with(entity);
  contacts_.forget(entity, system_);
  colliders_.remove(entity);
  ground_servos_.erase(std::ranges::lower_bound(ground_servos_, entity, {}, &GroundServo::entity),
                       std::ranges::upper_bound(ground_servos_, entity, {}, &GroundServo::entity));
}

void NewtonCore::remove(Body& body) {
  detach(body.entity);
  system_.trees[body.entity].clear();
  for (CoordinateJoint& joint : joints_of(body.entity, joints_)) {
    joint.present = false;
    joint.mode = scene::JointMode::disabled;
    joint.limit.reset();
  }
  body.articulation.reset();
}

void NewtonCore::take_back(Body& body) {
  detach(body.entity);
  system_.trees.pop_back();
  leapfrog_sync_.of_tree.pop_back();
  std::erase_if(joints_, [&](const auto& joint) { return joint.entity == body.entity; });
  body.articulation.reset();
}

void NewtonCore::move(Body& body) {
  dynamics::Tree& old = system_.trees[body.entity];
  dynamics::Tree tree(old, base_pose(body));
  tree.gravity = old.gravity;
  old = std::move(tree);
  begin_anew(*this, body.entity);
}

void begin_anew(NewtonCore& core, std::size_t entity) {
  core.end_grips_with(entity);
  for (CoordinateJoint& joint : joints_of(entity, core.joints_)) {
    joint.limit_impulse = joint.motor_impulse = 0;
  }
  for (NewtonCore::GroundServo& held : core.ground_servos_) {
    if (held.entity == entity) held.impulses = {};
  }
  core.contacts_.forget(entity, core.system_);
  core.leapfrog_sync_.of_tree[entity] = LeapfrogSync::unknown;
  core.system_.wake(static_cast<int>(entity));
  core.colliders_.reset_poses(entity, core.system_.trees[entity]);
}

void set_joint(NewtonCore& core, JointIndex index, double position, double velocity) {
  const CoordinateJoint& joint = core.joints_[index.value];
  dynamics::Tree& tree = core.system_.trees[joint.entity];
  tree.q[position_of(tree, joint.part)] = position;
  tree.v[dof_of(tree, joint.part)] = velocity;
  tree.integrator_step = 0;
  dynamics::forward_kinematics(tree);
  dynamics::velocity_kinematics(tree);
  begin_anew(core, joint.entity);
}

std::optional<std::size_t> NewtonCore::overlapped_by(std::span<const PlacedCollider> colliders,
                                                     std::size_t except) const {
  std::optional<std::size_t> first;
  for (const Collider& collider : colliders_.all) {
    if (!collider.is_present || collider.entity == except || (first && *first <= collider.entity))
      continue;
    const btVector3 part = to_bullet(system_.trees[collider.entity].position[collider.part]);
    const btScalar reach = collider.radius + collider.in_part.getOrigin().length();
    const auto is_far = [&](const PlacedCollider& each) {
      return part.distance(each.pose.getOrigin()) > reach + contact::bounding_radius(each.shape);
    };
    if (std::ranges::all_of(colliders, is_far)) continue;  // most are, and their poses take longer
    const PlacedCollider other{collider.shape, colliders_.pose(collider, system_)};
    if (std::ranges::any_of(
            colliders, [&](const auto& each) { return overlaps(each, other, resting_depth); })) {
      first = collider.entity;
    }
  }
  return first;
}

JointIndex NewtonCore::joint(std::size_t entity, std::size_t joint) const {
  const auto place = [](const CoordinateJoint& of) { return std::pair(of.entity, of.index); };
  const auto found = std::ranges::lower_bound(joints_, std::pair(entity, joint), {}, place);
  return {static_cast<std::size_t>(found - joints_.begin())};
}

void NewtonCore::add_motor(JointIndex index, scene::JointMode mode, double max_impulse) {
  joints_[index.value].mode = mode;
  joints_[index.value].max_impulse = max_impulse;
}

double NewtonCore::position(JointIndex index) const {
  const CoordinateJoint& joint = joints_[index.value];
  if (!joint.present) return 0;
  const dynamics::Tree& tree = system_.trees[joint.entity];
  return tree.q[position_of(tree, joint.part)];
}

double NewtonCore::velocity(JointIndex index) const {
  const CoordinateJoint& joint = joints_[index.value];
  if (!joint.present) return 0;
  const dynamics::Tree& tree = system_.trees[joint.entity];
  return tree.v[dof_of(tree, joint.part)];
}

}  // namespace ziggurat::physics
