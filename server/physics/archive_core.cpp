// SPDX-License-Identifier: MIT
// State of the core: all that its next substep reads. Boxes of the broad phase are left out: pairs
// do not depend on them.

#include <algorithm>

#include "physics/archive.h"
#include "physics/collision/contact_limits.h"
#include "physics/core.h"

namespace ziggurat::physics {

void Collider::archive(math::Archive& archive) {
  archive("pose", pose);
  archive("velocity", velocity);
  archive("angular_velocity", angular_velocity);
  archive("reach", reach);
}

void Colliders::archive(math::Archive& archive) {
  follow_anew();
  insert_new_groups();
  archive("all", all);
  archive("woke", has_woken);
  for (ColliderGroup& group : groups) {
    archive("rests", group.is_static);
    archive("rested", group.was_static);
    archive("low", group.low);
    archive("high", group.high);
    // update_poses() leaves out the boxes of static groups.
    if (archive.reads() && group.proxy) update_box(group, 0, true);
  }
}

void ContactCache::CachedPoint::archive(math::Archive& archive) {
  archive("on_a", on_a);
  archive("on_b", on_b);
  archive("point", point);
  archive("impulse", impulse);
  archive("angular_impulse", angular_impulse);
  archive("gap", gap);
  archive("carried", carried);
}

void ContactCache::CachedPair::archive(math::Archive& archive) {
  archive("live", live);
  if (!live) {
    if (archive.reads()) *this = {};
    return;
  }
  archive("a", a);
  archive("b", b);
  archive("seen", last_substep);
  archive("met", last_part);
  archive("rests", is_static);
  archive("normal", normal);
  archive("earlier", earlier_impulse);
  archive("share", force_share);
  archive("count", count);
  archive.require(count >= 0 && count <= most_points, "is too large");
  const int told =
      earlier_impulse.isZero(0) ? count : std::max(count, 1);  // see ContactCache::list_contacts()
  points.make_room(told);
  for (int i = 0; i < told; ++i) archive("point", points[i]);
}

void archive_fields(math::Archive& archive, ContactCache& contacts) {
  archive("substep", contacts.substep_);
  archive("part", contacts.part_);
  archive("resting", contacts.resting_);
  archive("live", contacts.live_);
  // Dead pairs take a byte each: there are as many as there once were pairs.
  const std::size_t colliders = contacts.colliders_.all.size();
  const std::size_t most_pairs =
      std::min(colliders * colliders / 2, 2 * most_near_pairs + colliders);
  try {
    archive.list("pairs", contacts.pairs_, 1 + most_pairs);
    archive.list("unused", contacts.unused_);
    contacts.check_pairs(archive);
  } catch (...) {  // half-read lists still get destroyed
    contacts.pairs_.clear();
    contacts.unused_.clear();
    throw;
  }
  if (!archive.reads()) return;
  contacts.places_.clear();
  contacts.floor_pairs_.assign(contacts.colliders_.all.size(), 0);
  contacts.pairs_of_collider_.clear();
  contacts.pairs_of_collider_.resize(contacts.colliders_.all.size());
  contacts.pairs_of_collider_.make_room(contacts.pairs_.size());
  for (std::size_t i = 1; i < contacts.pairs_.size(); ++i) {
    const ContactCache::CachedPair& pair = contacts.pairs_[i];
    if (!pair.live) continue;
    const bool is_floor = contacts.colliders_.floor == pair.b;
    (is_floor ? contacts.floor_pairs_[pair.a] : contacts.places_[key_of(pair.a, pair.b)]) =
        static_cast<int>(i);
    contacts.pairs_of_collider_.add(static_cast<int>(i), pair.a,
                                    is_floor ? std::nullopt : std::optional<std::size_t>(pair.b));
  }
  contacts.near_pairs_.clear();
  contacts.contacts_.clear();
  contacts.listed_.clear();
}

/// Checks pairs that were read, because they index lists. Each is of two entities in the order of
/// their colliders, one of which moves, or of a moving one and the floor.
void ContactCache::check_pairs(const math::Archive& archive) const {
  if (!archive.reads()) return;
  const std::size_t most = colliders_.all.size();
  std::size_t resting = 0;
  std::vector<std::uint64_t> keys;
  for (const CachedPair& pair : pairs_) {
    if (!pair.live) continue;
    archive.require(&pair != pairs_.data() && pair.a < most && pair.b < most, "is beyond its list");
    const Collider& a = colliders_.all[pair.a];
    const Collider& b = colliders_.all[pair.b];
    const bool is_floor = pair.b == colliders_.floor;
    archive.require(a.is_present && (b.is_present || is_floor), "touches what is not there");
    archive.require(is_floor || a.entity != b.entity, "touches its own entity");
    archive.require(is_floor || pair.a < pair.b, "has its colliders in another order");
    archive.require(a.moves || b.moves, "is of two colliders that stand");
    keys.push_back(key_of(pair.a, pair.b));
    resting += pair.is_static;
  }
  archive.require(keys.size() == live_ && resting == resting_, "counts wrongly");
  std::ranges::sort(keys);
  archive.require(std::ranges::adjacent_find(keys) == keys.end(), "has a pair twice");
  std::vector<bool> is_unused(pairs_.size());
  for (const int place : unused_) {
    const bool is_place = place > 0 && static_cast<std::size_t>(place) < pairs_.size();
    archive.require(is_place && !pairs_[static_cast<std::size_t>(place)].live &&
                        !is_unused[static_cast<std::size_t>(place)],
                    "is in use");
    is_unused[static_cast<std::size_t>(place)] = true;
  }
}

void Grip::archive(math::Archive& archive) {
  archive("entity", entity);
  archive("held", held);
  archive("part", part);
  archive("point", point);
  archive("distance", distance);
  archive("height", height);
  archive("bearing", bearing);
  archive("max_force", max_force);
  archive("spin", spin);
  archive("is_torn", is_torn);
  archive("impulses", impulses);
}

void archive_fields(math::Archive& archive, NewtonCore& core) {
  archive("system", core.system_);
  archive("colliders", core.colliders_);
  archive("contacts", core.contacts_);
  for (CoordinateJoint& joint : core.joints_) {
    archive("target", joint.target);
    archive("limit_impulse", joint.limit_impulse);
    archive("motor_impulse", joint.motor_impulse);
  }
  for (NewtonCore::GroundServo& held : core.ground_servos_) archive("held", held.impulses);
  const std::size_t entities = core.system_.trees.size();
  archive.list("grips", core.grips_, entities);
  for (std::size_t i = 0; i < core.grips_.size(); ++i) {
    const Grip& grip = core.grips_[i];
    archive.require(i == 0 || core.grips_[i - 1].entity < grip.entity, "grips out of order");
    archive.require(grip.entity < entities && grip.held < entities && grip.entity != grip.held &&
                        grip.part < core.system_.trees[grip.held].links.size(),
                    "is beyond its list");
    archive.require(std::ranges::binary_search(core.ground_servos_, grip.entity, {},
                                               &NewtonCore::GroundServo::entity),
                    "has no wheels");
    archive.require(core.system_.trees[grip.held].dofs > 0, "holds what does not move");
  }
  archive("lags", core.leapfrog_sync_.of_tree);
  archive("islands", core.convergence_.islands);
  archive("not_converged", core.convergence_.not_converged);
  archive("worst", core.convergence_.worst);
}

}  // namespace ziggurat::physics
