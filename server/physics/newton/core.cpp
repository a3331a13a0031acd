#include "physics/newton/core.h"

#include <algorithm>
#include <utility>

#include "physics/build.h"
#include "physics/make_room.h"
#include "physics/newton/tree.h"

namespace ziggurat::physics {
namespace {

/// What the dialect takes where a scene says nothing is for its own clock.
void forget_usual_damping(Body& body, const scene::Physics& physics) {
  if (physics.clock != scene::Clock::nominal) return;
  for (LinkBody& link : body.links) {
    if (link.damping.usual_linear) link.damping.linear = 0;
    if (link.damping.usual_angular) link.damping.angular = 0;
  }
}

std::vector<CoordinateJoint> make_joints(const scene::Entity& entity, const Body& body) {
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

}  // namespace

NewtonCore::NewtonCore(const scene::Physics& physics) : settings_(physics) {}

Body NewtonCore::add(const scene::Entity& entity, std::size_t number) {
  Body body = make_body(entity, settings_, number);
  forget_usual_damping(body, settings_);
  dynamics::Tree tree = make_tree(body, entity, settings_);
  const std::vector<CoordinateJoint> joints = make_joints(entity, body);
  make_room(system_.trees, 1);
  make_room(joints_, joints.size());
  make_room(held_, 1);
  colliders_.add(body, entity, tree);
  system_.trees.push_back(std::move(tree));
  joints_.insert(joints_.end(), joints.begin(), joints.end());
  if (body.ground && entity.movable) held_.push_back({number, {}});
  body.articulation = Articulation{&system_, number};
  return body;
}

void NewtonCore::detach(std::size_t entity) {
  contacts_.forget(entity, system_);
  colliders_.remove(entity);
  std::erase_if(held_, [&](const Held& held) { return held.entity == entity; });
}

void NewtonCore::remove(Body& body) {
  detach(body.entity);
  system_.trees[body.entity].take_apart();
  for (CoordinateJoint& joint : joints_) {
    if (joint.entity != body.entity) continue;
    joint.present = false;
    joint.mode = scene::JointMode::disabled;
    joint.limit.reset();
  }
  body.articulation.reset();
}

void NewtonCore::take_back(Body& body) {
  detach(body.entity);
  system_.trees.pop_back();
  std::erase_if(joints_, [&](const auto& joint) { return joint.entity == body.entity; });
  body.articulation.reset();
}

void NewtonCore::move(Body& body) {
  dynamics::Tree& old = system_.trees[body.entity];
  dynamics::Tree tree(old.links, base_pose(body), old.freedoms);
  tree.gravity = old.gravity;
  old = std::move(tree);
  for (CoordinateJoint& joint : joints_) {
    if (joint.entity == body.entity) joint.limit_impulse = joint.motor_impulse = 0;
  }
  for (Held& held : held_) {
    if (held.entity == body.entity) held.impulses = {};
  }
  contacts_.forget(body.entity, system_);
  system_.wake(static_cast<int>(body.entity));
  colliders_.moved(body.entity, old);
}

std::optional<std::size_t> NewtonCore::overlapped_by(
    std::span<const PlacedCollider> colliders) const {
  std::optional<std::size_t> first;
  for (const Collider& collider : colliders_.all) {
    if (!collider.present || (first && *first <= collider.entity)) continue;
    const PlacedCollider other{collider.shape, colliders_.pose(collider, system_)};
    if (std::ranges::any_of(colliders, [&](const auto& each) { return overlaps(each, other); })) {
      first = collider.entity;
    }
  }
  return first;
}

JointIndex NewtonCore::joint(std::size_t entity, std::size_t joint) const {
  std::size_t i = 0;
  while (joints_[i].entity != entity || joints_[i].index != joint) ++i;
  return {i};
}

void NewtonCore::add_motor(JointIndex index, scene::JointMode mode, double max_impulse) {
  joints_[index.value].mode = mode;
  joints_[index.value].max_impulse = max_impulse;
}

double NewtonCore::position(JointIndex index) const {
  const CoordinateJoint& joint = joints_[index.value];
  if (!joint.present) return 0;
  const dynamics::Tree& tree = system_.trees[joint.entity];
  return tree.q[place_of(tree, joint.part)];
}

double NewtonCore::velocity(JointIndex index) const {
  const CoordinateJoint& joint = joints_[index.value];
  if (!joint.present) return 0;
  const dynamics::Tree& tree = system_.trees[joint.entity];
  return tree.v[dof_of(tree, joint.part)];
}

void NewtonCore::set_servos_and_limits(std::span<Body> bodies, double length, int splits) {
  servos_.clear();
  limits_.clear();
  std::size_t entity = 0;  // joints of an entity stand together
  bool is_factored = false;
  for (const CoordinateJoint& joint : joints_) {
    dynamics::Tree& tree = system_.trees[joint.entity];
    if (std::exchange(entity, joint.entity) != joint.entity) is_factored = false;
    if (joint.mode != scene::JointMode::disabled) {
      servos_.push_back(servo_of(joint, tree, length, joint.max_impulse / splits, is_factored));
    }
    if (joint.limit) {
      limits_.push_back({static_cast<int>(joint.entity), static_cast<int>(joint.part),
                         joint.limit->lower, joint.limit->upper, joint.limit_impulse});
    }
  }
  for (const Held& held : held_) {
    for (const auto& servo : servos_of(bodies[held.entity], held.impulses)) {
      servos_.push_back(servo);
    }
  }
}

/// The impulses of this substep are where the next one begins.
void NewtonCore::remember() {
  contacts_.remember();
  std::size_t servo = 0, limit = 0;
  for (CoordinateJoint& joint : joints_) {
    if (joint.mode != scene::JointMode::disabled) joint.motor_impulse = servos_[servo++].impulse;
    if (joint.limit) joint.limit_impulse = limits_[limit++].impulse;
  }
  for (Held& held : held_) {
    for (double& impulse : held.impulses) impulse = servos_[servo++].impulse;
  }
}

void NewtonCore::substep(std::span<Body> bodies, double length, int splits) {
  colliders_.follow(system_, length);
  set_servos_and_limits(bodies, length, splits);
  std::span<dynamics::Contact> contacts = contacts_.find(length);
  if (system_.wake_disturbed(length, contacts, servos_)) contacts = contacts_.add_resting();
  const dynamics::Report report = system_.step(length, contacts, servos_, limits_);
  remember();
  convergence_.islands += report.islands;
  convergence_.not_converged += report.not_converged;
  convergence_.worst = std::max(convergence_.worst, report.miss);
}

}  // namespace ziggurat::physics
