// How the core moves all trees on by a substep: at once, and in parts where something asks for that.

#include <algorithm>
#include <utility>

#include "physics/newton/core.h"

namespace ziggurat::physics {
namespace {

/// What an overlap of bodies that magnets press together may remain [m]: with 64 N a micrometre is
/// 3e-4 of the bond of two magnets of 10 mm.
constexpr double overlap_of_magnets = 1e-7;

/// Into how many a substep may be divided for what is pulled too hard or nutates too far.
constexpr int most_parts = 200;

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
      system.apply_wrench(number, static_cast<int>(k), {share * push->moment, share * push->force});
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
  dynamics::PredictedVelocities& foresight;

  ~SpeedsComeBack() { swap_velocities(system.trees, foresight); }
};

/// @param trees  ascending
/// @param holds  whether it becomes the set of these trees, or of all others, which it does not list
void choose(TreeSet& out, std::span<const int> trees, bool holds, std::size_t count) {
  out.trees.assign(trees.begin(), holds ? trees.end() : trees.begin());
  out.holds.assign(count, !holds);
  for (const int tree : trees) out.holds[tree] = holds;
}

/// Takes several steps: each undoes four fifths of an overlap, and turns what it pushes.
void push_apart_what_turned(dynamics::System& system, Contacts& contacts, std::span<const int> trees) {
  constexpr int most_passes = 4;
  for (int pass = 0; pass < most_passes; ++pass) {
    const std::span<dynamics::ContactPoint> overlaps = contacts.find_turned(system);
    if (overlaps.empty()) return;
    system.separate(overlaps, trees);
  }
}

/// Wakes all trees but some.
/// @return  whether something slept
bool wake_others(dynamics::System& system, const TreeSet& those) {
  bool woke = false;
  for (std::size_t i = 0; i < those.holds.size(); ++i) {
    if (those.holds[i] || !system.is_asleep(static_cast<int>(i))) continue;
    system.wake(static_cast<int>(i));
    woke = true;
  }
  return woke;
}

}  // namespace

/// Tells the solver what a share allows, and collects its servos and limits.
void NewtonCore::prepare(std::span<Body> bodies, const Share& share) {
  system_.allowed_overlap = share.allowed_overlap;
  system_.compliance_factor = share.softness;
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
bool NewtonCore::wake_disturbed(const Share& share, std::span<dynamics::ContactPoint>& contacts, bool woke) {
  woke |= system_.wake_disturbed(share.length, contacts, servos_, share.trees());
  if (!woke || share.chosen) return woke;
  contacts = contacts_.add_resting();
  return system_.wake_disturbed(share.length, contacts, servos_, share.trees()) || woke;
}

/// Moves on what wake_disturbed() has been told.
void NewtonCore::step(const Share& share) {
  system_.rotations_until_impact = contacts_.swings;
  const dynamics::Report report = system_.advance(limits_);
  if (!system_.islands_to_subdivide.trees.empty()) {
    choose(chosen_, system_.islands_to_subdivide.trees, false, system_.trees.size());
    contacts_.keep(chosen_);
  }
  remember(share);
  push_apart_what_turned(system_, contacts_, share.trees());
  convergence_.islands += report.islands;
  convergence_.not_converged += report.not_converged;
  convergence_.worst = std::max(convergence_.worst, report.residual);
}

void NewtonCore::substep(std::span<Body> bodies, double length, int splits, Plugin* stiff) {
  Share whole;
  whole.length = length;
  whole.splits = splits;
  whole.most_parts = most_parts;
  colliders_.follow(system_, length);
  prepare(bodies, whole);
  std::span<dynamics::ContactPoint> contacts = contacts_.find(length);
  bool woke = false;
  if (stiff) {  // what takes the substep in parts must be awake
    division_.find(stiff->stiff_pairs(), contacts_.near(), {}, colliders_.all, system_.trees);
    woke = wake_others(system_, division_.with(0));
  }
  woke = wake_disturbed(whole, contacts, woke);
  woke |= foresee(whole, contacts, woke);
  if (!stiff) {
    change_lags(lags_, system_, work_, length, nullptr, contacts, servos_);
    step(whole);
    return divide(bodies, whole);
  }
  if (woke) {  // what has just woken, or is thrown, may touch others
    division_.find(stiff->stiff_pairs(), contacts_.near(), contacts, colliders_.all, system_.trees);
  }
  change_lags(lags_, system_, work_, length, &division_, contacts, servos_);
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
bool NewtonCore::foresee(const Share& share, std::span<dynamics::ContactPoint>& contacts, bool& woke) {
  constexpr int most_blows = 8;
  bool any = false;
  for (int i = 0; i < most_blows && system_.predict_velocities(limits_, least_reach(colliders_, share.length), colliders_.fast, foresight_); ++i) {
    const SpeedsComeBack at_the_end{system_, foresight_};
    swap_velocities(system_.trees, foresight_);
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
  std::span<dynamics::ContactPoint> contacts = contacts_.find(part.length, *part.chosen, part.of_impulses);
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
  std::swap(left_, system_.islands_to_subdivide);
  for (const auto& [parts, first, last] : left_.islands) {
    const std::span<const int> trees = std::span(left_.trees).subspan(first, last - first);
    if (parts >= many_parts && convergence_.divided++ == 0) {
      const auto links = [&](int tree) { return system_.trees[tree].links.size(); };
      convergence_.divided_entity = static_cast<std::size_t>(*std::ranges::max_element(trees, {}, links));
    }
    choose(chosen_, trees, true, system_.trees.size());
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
