#include "physics/newton/core.h"

#include <algorithm>
#include <utility>

#include "physics/build.h"
#include "physics/convert.h"
#include "physics/make_room.h"
#include "physics/newton/tree.h"

namespace ziggurat::physics {
namespace {

/// What an overlap of bodies that magnets press together may remain [m]: with 64 N a micrometre is
/// 3e-4 of the bond of two magnets of 10 mm.
constexpr double overlap_of_magnets = 1e-7;

/// Into how many a substep may be divided for what is pulled too hard or nutates too far.
constexpr int most_parts = 200;

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

/// Those of an entity: joints stand in the order of their entities.
std::span<CoordinateJoint> joints_of(std::size_t entity, std::vector<CoordinateJoint>& joints) {
  return {std::ranges::lower_bound(joints, entity, {}, &CoordinateJoint::entity),
          std::ranges::upper_bound(joints, entity, {}, &CoordinateJoint::entity)};
}

/// Entities of a kind mostly come one after the other, or by turns with a few others.
void share_mechanism(dynamics::Tree& tree, const std::vector<dynamics::Tree>& trees) {
  constexpr std::size_t most = 8;
  for (std::size_t i = 0; i < std::min(most, trees.size()); ++i) {
    if (tree.share(trees[trees.size() - 1 - i])) return;
  }
}

/// Those of all trees, if none are chosen.
template <class Item, class Visit>
void each_of(std::vector<Item>& items, const TreeSet* chosen, Visit visit) {
  if (chosen) return physics::each_of(items, *chosen, visit);
  std::for_each(items.begin(), items.end(), visit);
}

/// Notes what pushes some trees.
void note_pushes(const dynamics::System& system, const TreeSet& chosen, HeldBack& out) {
  out.pushes.clear();
  for (const int number : chosen.trees) {
    const auto& external = system.trees[number].external;
    out.pushes.insert(out.pushes.end(), external.begin(), external.end());
  }
}

/// Takes it from them, and their gravity.
void hold_back(dynamics::System& system, const TreeSet& chosen, HeldBack& out) {
  note_pushes(system, chosen, out);
  out.gravity.clear();
  out.gravity.reserve(chosen.trees.size());
  for (const int number : chosen.trees) out.gravity.push_back(system.trees[number].gravity);
  auto push = out.pushes.begin();
  for (const int number : chosen.trees) {
    dynamics::Tree& tree = system.trees[number];
    for (std::size_t k = 0; k < tree.links.size(); ++k, ++push) {
      push->force += tree.links[k].mass * tree.gravity;
      tree.external[k] = {};
    }
    tree.gravity.setZero();
  }
}

/// Pushes them so, times `share`.
void push(dynamics::System& system, const TreeSet& chosen, const HeldBack& held, double share) {
  auto push = held.pushes.begin();
  for (const int number : chosen.trees) {
    for (std::size_t k = 0; k < system.trees[number].links.size(); ++k, ++push) {
      system.push(number, static_cast<int>(k), {share * push->moment, share * push->force});
    }
  }
}

/// Gives trees back their gravity at its end, also where something throws.
struct GravityComesBack {
  dynamics::System& system;
  const TreeSet& chosen;
  const std::vector<math::Vector3>& gravity;  ///< see HeldBack

  ~GravityComesBack() {
    for (std::size_t i = 0; i < gravity.size(); ++i) {
      system.trees[chosen.trees[i]].gravity = gravity[i];
    }
  }
};

/// Gives trees back their speeds at its end, also where something throws.
struct SpeedsComeBack {
  dynamics::System& system;
  dynamics::Foresight& foresight;

  ~SpeedsComeBack() { swap_speeds(system.trees, foresight); }
};

/// @param trees  ascending
/// @param holds  whether it becomes the set of these trees, or of all others, which it does not list
void choose(TreeSet& out, std::span<const int> trees, bool holds, std::size_t count) {
  out.trees.assign(trees.begin(), holds ? trees.end() : trees.begin());
  out.holds.assign(count, !holds);
  for (const int tree : trees) out.holds[tree] = holds;
}

/// Takes two steps, because a push turns, too.
void push_apart_what_turned(dynamics::System& system, Contacts& contacts, std::span<const int> trees) {
  for (int pass = 0; pass < 2; ++pass) {
    const std::span<dynamics::Contact> overlaps = contacts.find_turned(system);
    if (overlaps.empty()) return;
    system.push_apart(overlaps, trees);
  }
}

/// Wakes all trees but some.
/// @return  whether something slept
bool wake_others(dynamics::System& system, const TreeSet& those) {
  bool woke = false;
  for (std::size_t i = 0; i < those.holds.size(); ++i) {
    if (those.holds[i] || !system.asleep(static_cast<int>(i))) continue;
    system.wake(static_cast<int>(i));
    woke = true;
  }
  return woke;
}

}  // namespace

NewtonCore::NewtonCore(const scene::Physics& physics) : settings_(physics) {}

Body NewtonCore::add(const scene::Entity& entity, std::size_t number) {
  Body body = make_body(entity, settings_, number);
  forget_usual_damping(body, settings_);
  dynamics::Tree tree = make_tree(body, entity, settings_);
  const std::vector<CoordinateJoint> joints = make_joints(entity, body);
  share_mechanism(tree, system_.trees);
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
  held_.erase(std::ranges::lower_bound(held_, entity, {}, &Held::entity),
              std::ranges::upper_bound(held_, entity, {}, &Held::entity));
}

void NewtonCore::remove(Body& body) {
  detach(body.entity);
  system_.trees[body.entity].take_apart();
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
  std::erase_if(joints_, [&](const auto& joint) { return joint.entity == body.entity; });
  body.articulation.reset();
}

void NewtonCore::move(Body& body) {
  dynamics::Tree& old = system_.trees[body.entity];
  dynamics::Tree tree(old, base_pose(body));
  tree.gravity = old.gravity;
  old = std::move(tree);
  for (CoordinateJoint& joint : joints_of(body.entity, joints_)) {
    joint.limit_impulse = joint.motor_impulse = 0;
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
    const btVector3 part = to_bullet(system_.trees[collider.entity].position[collider.part]);
    const btScalar reach = collider.radius + collider.in_part.getOrigin().length();
    const auto is_far = [&](const PlacedCollider& each) {
      return part.distance(each.pose.getOrigin()) > reach + contact::bounding_radius(each.shape);
    };
    if (std::ranges::all_of(colliders, is_far)) continue;  // most are, and their poses take longer
    const PlacedCollider other{collider.shape, colliders_.pose(collider, system_)};
    if (std::ranges::any_of(colliders, [&](const auto& each) { return overlaps(each, other); })) {
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
  return tree.q[place_of(tree, joint.part)];
}

double NewtonCore::velocity(JointIndex index) const {
  const CoordinateJoint& joint = joints_[index.value];
  if (!joint.present) return 0;
  const dynamics::Tree& tree = system_.trees[joint.entity];
  return tree.v[dof_of(tree, joint.part)];
}

/// Tells the solver what a share allows, and collects its servos and limits.
void NewtonCore::prepare(std::span<Body> bodies, const Share& share) {
  system_.allowed_overlap = share.allowed_overlap;
  system_.softness = share.softness;
  system_.most_parts = share.most_parts;
  system_.is_part = share.is_part;
  servos_.clear();
  limits_.clear();
  std::size_t entity = 0;  // joints of an entity stand together
  bool is_factored = false;
  each_of(joints_, share.chosen, [&](const CoordinateJoint& joint) {
    const dynamics::Tree& tree = system_.trees[joint.entity];
    if (std::exchange(entity, joint.entity) != joint.entity) is_factored = false;
    if (joint.mode != scene::JointMode::disabled) {
      const double impulse = joint.max_impulse / share.splits * share.of_impulses;
      servos_.push_back(servo_of(joint, tree, work_, share.length, share.parts_left * share.length, impulse, is_factored));
      servos_.back().impulse *= share.of_impulses;
    }
    if (joint.limit) {
      limits_.push_back({static_cast<int>(joint.entity), static_cast<int>(joint.part),
                         joint.limit->lower, joint.limit->upper,
                         share.of_impulses * joint.limit_impulse});
    }
  });
  each_of(held_, share.chosen, [&](const Held& held) {
    for (dynamics::Servo servo : servos_of(bodies[held.entity], held.impulses)) {
      servo.lower *= share.of_impulses;
      servo.upper *= share.of_impulses;
      servo.impulse *= share.of_impulses;
      servos_.push_back(servo);
    }
  });
}

/// The impulses of this substep are where the next one begins. Those of a part without forces are
/// not: the ones of the substep before are nearer to what comes.
void NewtonCore::remember(const Share& share) {
  contacts_.remember(share.more);
  if (share.of_impulses == 0) return;
  std::size_t servo = 0, limit = 0;
  each_of(joints_, share.chosen, [&](CoordinateJoint& joint) {
    if (joint.mode != scene::JointMode::disabled) {
      joint.motor_impulse = servos_[servo++].impulse / share.of_impulses;
    }
    if (joint.limit) joint.limit_impulse = limits_[limit++].impulse / share.of_impulses;
  });
  each_of(held_, share.chosen, [&](Held& held) {
    for (double& impulse : held.impulses) impulse = servos_[servo++].impulse / share.of_impulses;
  });
}

/// Wakes what something disturbs. Then what rests may be touched, too.
/// @param contacts  in and out;  @param woke  whether something woke before
/// @return          whether something has woken
bool NewtonCore::wake_disturbed(const Share& share, std::span<dynamics::Contact>& contacts, bool woke) {
  woke |= system_.wake_disturbed(share.length, contacts, servos_, share.trees());
  if (!woke || share.chosen) return woke;
  contacts = contacts_.add_resting();
  return system_.wake_disturbed(share.length, contacts, servos_, share.trees()) || woke;
}

/// Moves on what wake_disturbed() has been told.
void NewtonCore::step(const Share& share) {
  system_.swings = contacts_.swings;
  const dynamics::Report report = system_.advance(limits_);
  if (!system_.left.trees.empty()) {
    choose(chosen_, system_.left.trees, false, system_.trees.size());
    contacts_.keep(chosen_);
  }
  remember(share);
  push_apart_what_turned(system_, contacts_, share.trees());
  convergence_.islands += report.islands;
  convergence_.not_converged += report.not_converged;
  convergence_.worst = std::max(convergence_.worst, report.miss);
}

void NewtonCore::substep(std::span<Body> bodies, double length, int splits, Plugin* stiff) {
  Share whole;
  whole.length = length;
  whole.splits = splits;
  whole.most_parts = most_parts;
  colliders_.follow(system_, length);
  prepare(bodies, whole);
  std::span<dynamics::Contact> contacts = contacts_.find(length);
  bool woke = false;
  if (stiff) {  // what takes the substep in parts must be awake
    division_.find(stiff->stiff_pairs(), contacts_.near(), {}, colliders_.all, system_.trees);
    woke = wake_others(system_, division_.with(0));
  }
  woke = wake_disturbed(whole, contacts, woke);
  woke |= foresee(whole, contacts, woke);
  if (!stiff) {
    step(whole);
    return divide(bodies, whole);
  }
  if (woke) {  // what has just woken, or is thrown, may touch others
    division_.find(stiff->stiff_pairs(), contacts_.near(), contacts, colliders_.all, system_.trees);
  }
  whole.chosen = &division_.with(0);
  if (!whole.chosen->trees.empty()) {
    const auto is_other = [&](const auto& item) { return !whole.chosen->holds[item.tree]; };
    std::erase_if(servos_, is_other);
    std::erase_if(limits_, is_other);
    system_.wake_disturbed(length, contacts_.keep(*whole.chosen), servos_, whole.trees());
    step(whole);
    divide(bodies, whole);
  }
  for (const int count : division_.counts()) {
    substep_in_parts(bodies, length, splits, count, *stiff);
  }
}

/// Looks for contacts again with the speeds that things are set in motion with within the substep: what they would pass through is
/// beyond the reach that their speeds at its beginning give them. What they strike may be thrown, too.
/// @param contacts  in and out;  @param woke  in: whether something woke; out: also by what is thrown
/// @return          whether there are other contacts
bool NewtonCore::foresee(const Share& share, std::span<dynamics::Contact>& contacts, bool& woke) {
  constexpr int most_blows = 8;
  bool any = false;
  for (int i = 0; i < most_blows && system_.foresee(limits_, least_reach(share.length), colliders_.fast, foresight_); ++i) {
    const SpeedsComeBack at_the_end{system_, foresight_};
    swap_speeds(system_.trees, foresight_);
    if (!colliders_.widen(foresight_.trees, system_, share.length)) break;
    any = true;
    contacts = share.chosen ? contacts_.find(share.length, *share.chosen, share.of_impulses) : contacts_.find(share.length);
    woke = wake_disturbed(share, contacts, woke);
  }
  return any;
}

/// Moves some trees on by a part of the substep. What they may touch is awake.
void NewtonCore::take_part(std::span<Body> bodies, const Share& part) {
  colliders_.follow(system_, part.length, *part.chosen);
  prepare(bodies, part);
  std::span<dynamics::Contact> contacts = contacts_.find(part.length, *part.chosen, part.of_impulses);
  bool woke = wake_disturbed(part, contacts, false);
  foresee(part, contacts, woke);
  step(part);
}

/// Moves a set of trees on in steps of length / count. Forces act in the middle of each, as
/// impulses: a step ends half-way between two of them, so that places and velocities belong
/// together to second order (drift, kick, drift). All that acts does so, gravity and motors too,
/// because friction that holds against a force must have the same share of what presses.
void NewtonCore::substep_in_parts(std::span<Body> bodies, double length, int splits, int count,
                                  Plugin& stiff) {
  const TreeSet& chosen = division_.with(count);
  Share share;
  share.chosen = &chosen;
  share.splits = splits;
  share.allowed_overlap = overlap_of_magnets;
  share.softness = 0;  // half of the parts have no forces, so nothing that presses
  contacts_.choose(chosen);
  stiff.choose_stiff(chosen.holds);
  stiff.push_stiff(bodies, -1);
  held_back_.gravity.clear();
  const GravityComesBack at_the_end{system_, chosen, held_back_.gravity};
  hold_back(system_, chosen, held_back_);
  for (int i = 0; i <= count; ++i) {
    const bool half = i == 0 || i == count;
    const double kick = i == 0 ? 0 : half ? 2 : 1;  // of the forces over this length
    share.length = length / count / (half ? 2 : 1);
    share.of_impulses = kick * share.length / length;
    share.more = i < count;
    if (i > 0) {
      push(system_, chosen, held_back_, kick);
      stiff.push_stiff(bodies, kick);
    }
    take_part(bodies, share);
  }
}

/// Moves the islands on that the whole substep left as they were.
void NewtonCore::divide(std::span<Body> bodies, const Share& whole) {
  std::swap(left_, system_.left);
  for (const auto& [parts, first, last] : left_.islands) {
    choose(chosen_, std::span(left_.trees).subspan(first, last - first), true, system_.trees.size());
    take_parts(bodies, whole, parts);
  }
}

/// Moves chosen_ on in equal parts. What pushes it stays the same.
void NewtonCore::take_parts(std::span<Body> bodies, const Share& whole, int count) {
  note_pushes(system_, chosen_, held_back_);
  Share part = whole;
  part.chosen = &chosen_;
  part.length /= count;
  part.of_impulses /= count;
  part.most_parts = 1;
  part.is_part = true;
  contacts_.choose(chosen_);
  for (int i = 0; i < count; ++i) {
    part.parts_left = count - i;
    part.more = part.parts_left > 1;
    if (i > 0) push(system_, chosen_, held_back_, 1);
    take_part(bodies, part);
  }
}

}  // namespace ziggurat::physics
