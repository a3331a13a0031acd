// SPDX-License-Identifier: MIT
// Pairs of colliders in the contact cache, and their impulses.

#include <algorithm>

#include "physics/collision/contact_cache.h"
#include "physics/multibody/prefetch.h"

namespace ziggurat::physics {
namespace {

ContactSide side(const Collider& collider) {
  if (collider.entity == Collider::floor) return {};
  return {collider.entity, collider.link};
}

}  // namespace

/// Returns the pair with a number, or makes a new one.
ContactCache::CachedPair& ContactCache::pair_of(std::size_t a, std::size_t b, int& place) {
  if (place == 0) {
    if (unused_.empty()) {
      if (pairs_.empty()) pairs_.emplace_back();
      unused_.push_back(static_cast<int>(pairs_.size()));
      pairs_.emplace_back();
      unused_.reserve(pairs_.capacity());  // drop_pair() and forget() take no memory
      forgotten_.reserve(pairs_.capacity());
      pairs_of_collider_.make_room(pairs_.size());
    }
    place = unused_.back();
    unused_.pop_back();
    pairs_[place] = {};
    pairs_[place].a = static_cast<std::uint32_t>(a);
    pairs_[place].b = static_cast<std::uint32_t>(b);
    pairs_[place].live = true;
    pairs_of_collider_.add(place, a, b == colliders_.floor ? std::nullopt : std::optional(b));
    ++live_;
  }
  if (pairs_[place].last_substep != substep_) pairs_[place].earlier_impulse.setZero();
  pairs_[place].last_substep = substep_;
  return pairs_[place];
}

void ContactCache::drop_pair(std::size_t number) {
  CachedPair& pair = pairs_[number];
  pairs_of_collider_.remove(static_cast<int>(number));
  pair.live = false;
  pair.count = 0;
  --live_;
  resting_ -= pair.is_static;
  unused_.push_back(static_cast<int>(number));
  if (colliders_.floor != pair.b) {
    places_.erase(key_of(pair.a, pair.b));
  } else if (pair.a < floor_pairs_.size()) {
    floor_pairs_[pair.a] = 0;
  }
}

/// Drops pairs that came apart.
void ContactCache::drop_separated_pairs() {
  for (std::size_t i = 1; i < pairs_.size(); ++i) {
    const CachedPair& pair = pairs_[i];
    if (!pair.live || pair.last_substep == substep_) continue;
    const bool rests = colliders_.is_static(colliders_.all[pair.a]) &&
                       colliders_.is_static(colliders_.all[pair.b]);
    if (!rests) drop_pair(i);
  }
}

void ContactCache::forget(std::size_t entity, dynamics::System& system) {
  forgotten_.clear();
  for (const ColliderGroup& group : colliders_.groups_of(entity)) {
    for (std::size_t i = 0; i < group.count; ++i)
      pairs_of_collider_.collect(group.first + i, forgotten_);
  }
  std::sort(forgotten_.begin(), forgotten_.end());  // the lists' order is no state
  for (const int number : forgotten_) {
    for (const std::size_t i : {pairs_[number].a, pairs_[number].b}) {
      const std::size_t other = colliders_.all[i].entity;
      if (other != Collider::floor) system.wake(static_cast<int>(other));
    }
    drop_pair(static_cast<std::size_t>(number));
  }
}

void ContactCache::store_impulses(bool more) {
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    if (i + ahead < contacts_.size()) {
      const CacheIndex& owner = cache_indices_[i + ahead];
      const CachedPair& pair = pairs_[owner.pair];
      dynamics::prefetch(&contacts_[i + ahead].impulse, 2 * sizeof(math::Vector3));
      dynamics::prefetch(&pair.force_share, sizeof(pair.force_share));
      dynamics::prefetch(&pair.points[owner.point].impulse, 2 * sizeof(math::Vector3));
    }
    CachedPair& pair = pairs_[cache_indices_[i].pair];
    CachedPoint& point = pair.points[cache_indices_[i].point];
    if (more) pair.earlier_impulse += contacts_[i].impulse;
    if (force_share_ == 0) continue;
    point.impulse = contacts_[i].impulse / force_share_;
    point.angular_impulse = contacts_[i].angular_impulse / force_share_;
    point.carried = !contacts_[i].impulse.isZero(0);
    pair.force_share = force_share_;
  }
}

void ContactCache::store_estimates() {
  if (force_share_ == 0) return;
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    CachedPoint& point = pairs_[cache_indices_[i].pair].points[cache_indices_[i].point];
    point.impulse = contacts_[i].impulse / force_share_;
    point.angular_impulse = contacts_[i].angular_impulse / force_share_;
  }
}

void ContactCache::add_impact_impulses() {
  for (std::size_t i = 0; i < contacts_.size(); ++i)
    pairs_[cache_indices_[i].pair].earlier_impulse += contacts_[i].impulse;
}

void ContactCache::list_contacts(std::vector<LinkContact>& out) const {
  out.clear();
  for (const CachedPair& pair : pairs_) {
    math::Vector3 middle(0, 0, 0), sum = pair.earlier_impulse;
    int count = 0;
    for (int i = 0; i < pair.count; ++i) {
      const CachedPoint& point = pair.points[i];
      const bool pressed = point.impulse.dot(pair.normal) > 0 || !pair.earlier_impulse.isZero(0);
      if (!pressed && point.gap > 0) continue;
      middle += point.point;
      sum += pair.force_share * point.impulse;
      ++count;
    }
    const bool came_apart = pair.live && pair.count == 0 && pair.last_substep == substep_ &&
                            !pair.earlier_impulse.isZero(0);
    if (came_apart) middle = pair.points[0].point, count = 1;
    if (count == 0) continue;
    out.push_back(in_order({side(colliders_.all[pair.a]), side(colliders_.all[pair.b]), pair.normal,
                            middle / count, sum}));
  }
  sort(out);
}

}  // namespace ziggurat::physics
