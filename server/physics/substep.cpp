// SPDX-License-Identifier: MIT
// A substep of all trees: as a whole, and in parts where a stiff pair or an island asks for them.

#include <algorithm>
#include <utility>

#include "physics/core.h"

namespace ziggurat::physics {
namespace {

/// Penetration that remains between magnetic bodies [m]: with 64 N a micrometre is 3e-4 of the bond
/// of two magnets of 10 mm.
constexpr double overlap_of_magnets = 1e-7;

/// Largest number of parts of a substep for geometric or gyroscopic stiffness.
constexpr int most_parts_of_island = 200;

/// Calls visit for the items of all trees, if none are chosen.
template <class Item, class Visit>
void each_of(std::vector<Item>& items, const TreeSet* active, Visit visit) {
  if (active) return physics::each_of(items, *active, visit);
  std::for_each(items.begin(), items.end(), visit);
}

/// Saves the external wrenches of some trees.
void save_wrenches(const dynamics::System& system, const TreeSet& active, DeferredForces& out) {
  out.wrenches.clear();
  for (const int number : active.trees) {
    const auto& external = system.trees[number].external;
    out.wrenches.insert(out.wrenches.end(), external.begin(), external.end());
  }
}

/// Moves the external wrenches and gravity of some trees to the deferred forces.
void defer_forces(dynamics::System& system, const TreeSet& active, DeferredForces& out) {
  save_wrenches(system, active, out);
  out.gravity.clear();
  out.gravity.reserve(active.trees.size());
  for (const int number : active.trees) out.gravity.push_back(system.trees[number].gravity);
  auto push = out.wrenches.begin();
  for (const int number : active.trees) {
    dynamics::Tree& tree = system.trees[number];
    for (std::size_t k = 0; k < tree.links.size(); ++k, ++push) {
      push->force += tree.links[k].mass * tree.gravity;
      tree.external[k] = {};
    }
    tree.gravity.setZero();
  }
}

/// Applies the deferred forces, times `share`.
void apply_deferred(dynamics::System& system, const TreeSet& active, const DeferredForces& deferred,
                    double share) {
  auto push = deferred.wrenches.begin();
  for (const int number : active.trees) {
    for (std::size_t k = 0; k < system.trees[number].links.size(); ++k, ++push) {
      system.apply_wrench(number, static_cast<int>(k), {share * push->moment, share * push->force});
    }
  }
}

/// Restores the gravity of trees at its end, also after an exception.
struct GravityGuard {
  dynamics::System& system;
  const TreeSet& active;
  const std::vector<math::Vector3>& gravity;  ///< see DeferredForces

  ~GravityGuard() {
    for (std::size_t i = 0; i < gravity.size(); ++i) {
      system.trees[active.trees[i]].gravity = gravity[i];
    }
  }
};

/// Restores the velocities of trees at its end, also after an exception.
struct VelocityGuard {
  dynamics::System& system;
  dynamics::PredictedVelocities& foresight;

  ~VelocityGuard() { swap_velocities(system.trees, foresight); }
};

/// Sets the active trees.
/// @param trees  ascending
/// @param holds  whether it becomes the set of these trees, or of all others, which it does not
///               list
void set_active(TreeSet& out, std::span<const int> trees, bool holds, std::size_t count) {
  out.trees.assign(trees.begin(), holds ? trees.end() : trees.begin());
  out.contains.assign(count, !holds);
  for (const int tree : trees) out.contains[tree] = holds;
}

/// Recovers overlaps by several steps: each resolves four fifths, and rotates the bodies.
void recover_overlaps(dynamics::System& system, ContactCache& contacts,
                      std::span<const int> trees) {
  constexpr int most_passes = 4;
  for (int pass = 0; pass < most_passes; ++pass) {
    const std::span<dynamics::ContactPoint> overlaps = contacts.find_new_overlaps(system);
    if (overlaps.empty()) return;
    system.separate(overlaps, trees);
  }
}

/// Wakes all trees but some.
/// @return  whether one slept
bool wake_all_except(dynamics::System& system, const TreeSet& those) {
  bool woke = false;
  for (std::size_t i = 0; i < those.contains.size(); ++i) {
    if (those.contains[i] || !system.is_asleep(static_cast<int>(i))) continue;
    system.wake(static_cast<int>(i));
    woke = true;
  }
  return woke;
}

/// Counts a substep that trees took in many parts; of the first such trees it keeps the one of most
/// links.
void count_divided(const dynamics::System& system, std::span<const int> trees, int parts,
                   Convergence& convergence) {
  if (parts < many_parts || convergence.divided++ > 0) return;
  const auto links = [&](int tree) { return system.trees[tree].links.size(); };
  convergence.divided_entity =
      static_cast<std::size_t>(*std::ranges::max_element(trees, {}, links));
}

}  // namespace

/// Sets the system's options for a part, and collects its servos and limits.
void NewtonCore::prepare(std::span<Body> bodies, const SubstepPart& part) {
  system_.options = part.options;
  servos_.clear();
  limits_.clear();
  std::size_t entity = 0;  // joints of an entity stand together
  bool is_factored = false;
  each_of(joints_, part.active, [&](const CoordinateJoint& joint) {
    const dynamics::Tree& tree = system_.trees[joint.entity];
    if (std::exchange(entity, joint.entity) != joint.entity) is_factored = false;
    if (joint.mode != scene::JointMode::disabled) {
      const double impulse = joint.max_impulse / part.splits * part.force_share;
      servos_.push_back(
          servo_of(joint, tree, work_, part.time_step, part.time_to_target, impulse, is_factored));
      servos_.back().impulse *= part.force_share;
    }
    if (joint.limit) {
      limits_.push_back({static_cast<int>(joint.entity), static_cast<int>(joint.part),
                         joint.limit->lower, joint.limit->upper,
                         part.force_share * joint.limit_impulse});
    }
  });
  each_of(ground_servos_, part.active, [&](const GroundServo& held) {
    for (dynamics::Servo servo : servos_of(bodies[held.entity], held.impulses)) {
      servo.lower *= part.force_share;
      servo.upper *= part.force_share;
      servo.impulse *= part.force_share;
      servos_.push_back(servo);
    }
  });
  each_of(grips_, part.active, [&](const Grip& grip) {
    if (grip.is_torn) return;
    for (dynamics::Servo servo : servos_of(grip, bodies, part.time_step)) {
      servo.lower *= part.force_share;
      servo.upper *= part.force_share;
      servo.impulse *= part.force_share;
      servos_.push_back(servo);
    }
  });
}

/// Stores the impulses: the next substep starts from them. A part without forces stores none: the
/// substep before is a better start.
void NewtonCore::store_impulses(const SubstepPart& part) {
  contacts_.store_impulses(part.is_followed);
  if (part.force_share == 0) return;
  std::size_t servo = 0, limit = 0;
  each_of(joints_, part.active, [&](CoordinateJoint& joint) {
    if (joint.mode != scene::JointMode::disabled) {
      joint.motor_impulse = servos_[servo++].impulse / part.force_share;
    }
    if (joint.limit) joint.limit_impulse = limits_[limit++].impulse / part.force_share;
  });
  each_of(ground_servos_, part.active, [&](GroundServo& held) {
    for (double& impulse : held.impulses) impulse = servos_[servo++].impulse / part.force_share;
  });
  each_of(grips_, part.active, [&](Grip& grip) {
    if (grip.is_torn) return;
    for (double& impulse : grip.impulses) impulse = servos_[servo++].impulse / part.force_share;
  });
}

/// Wakes disturbed sleepers. Then contacts of other sleepers are needed, too.
/// @param contacts  in and out;  @param woke  whether something woke before
/// @return          whether something has woken
bool NewtonCore::wake_disturbed(const SubstepPart& part,
                                std::span<dynamics::ContactPoint>& contacts, bool woke) {
  woke |= system_.wake_disturbed(part.time_step, contacts, servos_, part.trees());
  if (!woke || part.active) return woke;
  contacts = contacts_.add_resting_contacts();
  return system_.wake_disturbed(part.time_step, contacts, servos_, part.trees()) || woke;
}

/// Advances by the constraints of wake_disturbed().
void NewtonCore::step(const SubstepPart& part) {
  system_.rotations_until_impact = contacts_.rotations_until_impact;
  const dynamics::Report report = system_.advance(limits_, watch_);
  if (!system_.islands_to_subdivide.trees.empty()) {
    set_active(stepped_, system_.islands_to_subdivide.trees, false, system_.trees.size());
    contacts_.keep_contacts(stepped_);
  }
  store_impulses(part);
  recover_overlaps(system_, contacts_, part.trees());
  convergence_.islands += report.islands;
  convergence_.not_converged += report.not_converged;
  convergence_.worst = std::max(convergence_.worst, report.residual);
  if (!part.is_part)
    count_divided(system_, std::span(&report.most_evaluated_tree, 1), report.most_evaluations,
                  convergence_);
}

void NewtonCore::substep(std::span<Body> bodies, double time_step, int splits, Plugin* stiff,
                         timing::Stopwatch* watch) {
  watch_ = watch;
  enter(watch_, timing::Phase::contacts);
  for (const Grip& grip : grips_) {
    if (is_commanded_anew(grip, bodies)) system_.wake(static_cast<int>(grip.entity));
  }
  SubstepPart whole;
  whole.time_step = whole.time_to_target = time_step;
  whole.splits = splits;
  whole.options.most_parts = most_parts_of_island;
  colliders_.update_poses(system_, time_step);
  prepare(bodies, whole);
  std::span<dynamics::ContactPoint> contacts = contacts_.find_contacts(time_step);
  bool woke = false;
  if (stiff) {  // trees with parts must be awake
    partition_.partition(stiff->stiff_pairs(), contacts_.near_pairs(), {}, servos_, colliders_.all,
                         system_.trees);
    woke = wake_all_except(system_, partition_.trees_with(0));
  }
  woke = wake_disturbed(whole, contacts, woke);
  woke |= predict_contacts(whole, contacts, woke);
  if (!stiff) {
    synchronise_velocities(leapfrog_sync_, system_, work_, time_step, nullptr, contacts, servos_);
    step(whole);
    return step_divided_islands(bodies, whole);
  }
  if (woke) {  // trees that woke or were accelerated may touch others
    partition_.partition(stiff->stiff_pairs(), contacts_.near_pairs(), contacts, servos_,
                         colliders_.all, system_.trees);
  }
  synchronise_velocities(leapfrog_sync_, system_, work_, time_step, &partition_, contacts, servos_);
  whole.active = &partition_.trees_with(0);
  if (!whole.active->trees.empty()) {
    const auto is_other = [&](const auto& item) { return !whole.active->contains[item.tree]; };
    std::erase_if(servos_, is_other);
    std::erase_if(limits_, is_other);
    system_.wake_disturbed(time_step, contacts_.keep_contacts(*whole.active), servos_,
                           whole.trees());
    step(whole);
    step_divided_islands(bodies, whole);
  }
  for (const int count : partition_.part_counts()) {
    step_leapfrog(bodies, time_step, splits, count, *stiff);
  }
}

/// Finds contacts again with the velocities that servos, wrenches and impacts give within the
/// substep. Their obstacles are beyond the reach of the initial velocities. Impacts may accelerate
/// further bodies.
/// @param contacts  in and out;  @param woke  in: whether something woke; out: also by an impact
/// @return          whether there are other contacts
bool NewtonCore::predict_contacts(const SubstepPart& part,
                                  std::span<dynamics::ContactPoint>& contacts, bool& woke) {
  constexpr int most_blows = 8;
  bool any = false;
  for (int i = 0; i < most_blows && system_.predict_velocities(
                                        limits_, speculative_margin(colliders_, part.time_step),
                                        colliders_.fast_entities, prediction_);
       ++i) {
    const VelocityGuard at_the_end{system_, prediction_};
    swap_velocities(system_.trees, prediction_);
    if (!colliders_.add_predictions(prediction_.trees, system_, part.time_step)) break;
    any = true;
    contacts_.store_estimates();
    contacts = part.active ? contacts_.find_contacts(part.time_step, *part.active, part.force_share)
                           : contacts_.find_contacts(part.time_step);
    woke = wake_disturbed(part, contacts, woke);
  }
  return any;
}

/// Advances some trees by a part of the substep, but those whose impacts end it. Trees that they
/// may touch are awake.
void NewtonCore::step_active(std::span<Body> bodies, const SubstepPart& part) {
  enter(watch_, timing::Phase::contacts);
  colliders_.update_poses(system_, part.time_step, *part.active);
  prepare(bodies, part);
  std::span<dynamics::ContactPoint> contacts =
      contacts_.find_contacts(part.time_step, *part.active, part.force_share);
  bool woke = wake_disturbed(part, contacts, false);
  predict_contacts(part, contacts, woke);
  step(part);
}

/// Advances some trees by a part of the substep. Trees that they may touch are awake.
void NewtonCore::step_part(std::span<Body> bodies, const SubstepPart& part) {
  step_active(bodies, part);
  std::swap(islands_with_impacts_, system_.islands_to_subdivide);
  for (const auto& [parts, impact_time, first, last] : islands_with_impacts_.islands) {
    step_to_impacts(bodies, part,
                    std::span(islands_with_impacts_.trees).subspan(first, last - first),
                    impact_time);
  }
}

/// Applies the impact law where a set of trees is now. Motors may give at once what they give in
/// the part.
void NewtonCore::apply_impacts(std::span<Body> bodies, const SubstepPart& part) {
  const double near =
      1e-3 * part.time_step;  // contacts are those within the reach of this time [s]
  enter(watch_, timing::Phase::contacts);
  colliders_.update_poses(system_, near, *part.active);
  prepare(bodies, part);
  const auto contacts = contacts_.find_contacts(near, *part.active, part.force_share);
  enter(watch_, timing::Phase::solve);
  system_.apply_impacts(contacts, servos_, limits_, part.trees());
  contacts_.add_impact_impulses();
}

/// Advances an island that a part of the substep left unchanged for its impacts. Wrenches act
/// wholly at the beginning.
void NewtonCore::step_to_impacts(std::span<Body> bodies, const SubstepPart& whole,
                                 std::span<const int> trees, double first_impact) {
  set_active(in_impacts_, trees, true, system_.trees.size());
  contacts_.begin_parts(in_impacts_);
  double wrench_time = whole.time_step;  // in which the wrenches that are left act [s]
  const auto advance = [&](double time_step, double left, dynamics::ImpactMode mode) {
    for (const int number : in_impacts_.trees) {
      for (dynamics::Wrench& wrench : system_.trees[number].external) {
        wrench.force *= wrench_time / time_step;
        wrench.moment *= wrench_time / time_step;
      }
    }
    wrench_time = time_step;
    SubstepPart part = whole;
    part.active = &in_impacts_;
    part.time_step = time_step;
    part.force_share *= time_step / whole.time_step;
    part.time_to_target += left - whole.time_step;
    part.options.most_parts = 1;
    part.is_part = true;
    part.options.impact_mode = mode;
    part.is_followed |= mode == dynamics::ImpactMode::between;
    step_active(bodies, part);
    double next = HUGE_VAL;
    auto& unchanged = system_.islands_to_subdivide;
    if (unchanged.trees.empty()) return next;
    for (const auto& island : unchanged.islands) next = std::min(next, island.impact_time);
    std::ranges::sort(unchanged.trees);
    set_active(in_impacts_, unchanged.trees, true, system_.trees.size());
    contacts_.begin_parts(in_impacts_);
    return next;
  };
  const auto strike = [&] {
    SubstepPart part = whole;
    part.active = &in_impacts_;
    apply_impacts(bodies, part);
  };
  dynamics::step_through_impacts(whole.time_step, first_impact, advance, strike);
}

/// Moves a set of trees by leapfrog steps of length / count (drift, kick, drift). Forces act as
/// impulses in the middle of each. A step ends half-way between two of them, so positions and
/// velocities agree to second order. Gravity and motors act alike, because friction against a force
/// needs the same share of the normal load.
void NewtonCore::step_leapfrog(std::span<Body> bodies, double time_step, int splits, int count,
                               Plugin& stiff) {
  const TreeSet& active = partition_.trees_with(count);
  SubstepPart part;
  part.active = &active;
  part.splits = splits;
  part.options.allowed_overlap = overlap_of_magnets;
  part.options.compliance_factor = 0;  // half of the parts have no forces, so no normal load
  contacts_.begin_parts(active);
  enter(watch_, stiff.phase());
  stiff.choose_stiff(active.contains);
  stiff.push_stiff(bodies, -1);
  deferred_forces_.gravity.clear();
  const GravityGuard at_the_end{system_, active, deferred_forces_.gravity};
  defer_forces(system_, active, deferred_forces_);
  for (int i = 0; i <= count; ++i) {
    const bool half = i == 0 || i == count;
    const double kick = i == 0 ? 0 : half ? 2 : 1;  // of the forces over this length
    part.time_step = part.time_to_target = time_step / count / (half ? 2 : 1);
    part.force_share = kick * part.time_step / time_step;
    part.is_followed = i < count;
    if (i > 0) {
      enter(watch_, stiff.phase());
      apply_deferred(system_, active, deferred_forces_, kick);
      stiff.push_stiff(bodies, kick);
    }
    step_part(bodies, part);
  }
}

/// Advances the islands that the whole substep left unchanged.
void NewtonCore::step_divided_islands(std::span<Body> bodies, const SubstepPart& whole) {
  std::swap(islands_to_subdivide_, system_.islands_to_subdivide);
  for (const auto& [parts, impact_time, first, last] : islands_to_subdivide_.islands) {
    const std::span<const int> trees =
        std::span(islands_to_subdivide_.trees).subspan(first, last - first);
    if (parts == 0) {
      step_to_impacts(bodies, whole, trees, impact_time);
      continue;
    }
    count_divided(system_, trees, parts, convergence_);
    set_active(active_, trees, true, system_.trees.size());
    step_in_parts(bodies, whole, parts);
  }
}

/// Advances active_ in equal parts, under constant wrenches.
void NewtonCore::step_in_parts(std::span<Body> bodies, const SubstepPart& whole, int count) {
  save_wrenches(system_, active_, deferred_forces_);
  SubstepPart part = whole;
  part.active = &active_;
  part.time_step /= count;
  part.force_share /= count;
  part.options.most_parts = 1;
  part.is_part = true;
  contacts_.begin_parts(active_);
  for (int i = 0; i < count; ++i) {
    part.time_to_target = (count - i) * part.time_step;
    part.is_followed = i + 1 < count;
    if (i > 0) apply_deferred(system_, active_, deferred_forces_, 1);
    step_part(bodies, part);
  }
}

}  // namespace ziggurat::physics
